import { If, float, int } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { Float, Int } from '../../tsl-types'
import { forLayers, layerAt, type LayerRange } from '../../density/tsl/layer'

/** Distance farther than anything [m]. */
export const FAR_AWAY = 1e12

/** The two distances at which a ray's line crosses the sphere at an altitude; `FAR_AWAY` if none. */
export function crossings(
  field: CloudField,
  cosView: Float,
  altitude: Float
): { near: Float; far: Float } {
  const { height } = field.view
  const radial = field.radius.add(height).mul(cosView).toConst() as Float
  const product = height.sub(altitude).mul(field.radius.mul(2).add(height).add(altitude)).toConst()
  const discriminant = radial.mul(radial).sub(product).toConst()
  // The roots of t² + 2bt + c as q and c/q, q = −(b ± √D): nothing cancels.
  const root = discriminant.max(0).sqrt()
  const q = radial
    .add(select(radial.lessThan(0), root.negate(), root))
    .negate()
    .toConst() as Float
  // Where q is 0, so is c.
  const other = product.div(select(q.equal(0), 1, q))
  const meets = discriminant.greaterThan(0)
  return {
    near: select(meets, q.min(other), FAR_AWAY).toConst(),
    far: select(meets, q.max(other), FAR_AWAY).toConst()
  }
}

/** Distance to where a ray from the camera meets the sphere at altitude 0; `FAR_AWAY` if it does not. */
export function groundDistance(field: CloudField, cosView: Float): Float {
  const { near } = crossings(field, cosView, float(0))
  return select(near.greaterThan(0), near, FAR_AWAY).toConst()
}

/**
 * Next layer boundary: the first place after a distance where a ray enters or leaves a layer that covers anything.
 *
 * @param cosView - Ray against the zenith of the camera.
 * @returns Distance from the camera; `FAR_AWAY` if there is none [m].
 */
export function nextLayerBoundary(field: CloudField, cosView: Float, distance: Float): Float {
  const next = float(FAR_AWAY).toVar()
  const consider = (at: Float): void => {
    next.assign(select(at.greaterThan(distance), next.min(at), next))
  }
  forLayers(field, index => {
    const { baseAltitude, thickness, coverage } = layerAt(field, index)
    // Steps begin anew behind a boundary: those of layers without clouds are none.
    If(coverage.greaterThan(0), () => {
      for (const altitude of [baseAltitude, baseAltitude.add(thickness)]) {
        const { near, far } = crossings(field, cosView, altitude)
        consider(near)
        consider(far)
      }
    })
  })
  return next
}

/** The layers around an altitude, taken together. */
export interface LayersAt {
  /** Altitude of the lowest base; above `top` if no layer is there [m]. */
  base: Float
  /** Altitude of the highest top [m]. */
  top: Float
  /** 1 where clouds are plane-parallel layers, 0 where each is as wide as it is deep. */
  layered: Float
  /** Greatest extinction of a layer [1/m]. */
  density: Float
  /** Range of indices that has all of them, and perhaps others between. */
  range: LayerRange
}

/**
 * Coverages between which isolated clouds grow together to a deck. Lower: *Cumulus* are lit like a deck,
 * dark between their tops.
 */
export const GROWING_TOGETHER = [0.35, 1] as const

/**
 * Layers around an altitude.
 *
 * @param altitude - Above the sphere [m].
 */
export function layersAt(field: CloudField, altitude: Float): LayersAt {
  const base = float(FAR_AWAY).toVar()
  const top = float(-FAR_AWAY).toVar()
  const coverage = float(0).toVar()
  const density = float(0).toVar()
  const first = int(field.layers.length).toVar() as Int
  const last = int(0).toVar() as Int
  forLayers(field, index => {
    const layer = layerAt(field, index)
    const layerTop = layer.baseAltitude.add(layer.thickness).toConst()
    const isInside = altitude
      .greaterThanEqual(layer.baseAltitude)
      .and(altitude.lessThanEqual(layerTop))
      .and(layer.coverage.greaterThan(0))
    If(isInside, () => {
      base.assign(base.min(layer.baseAltitude))
      top.assign(top.max(layerTop))
      coverage.assign(coverage.max(layer.coverage))
      density.assign(density.max(layer.density))
      first.assign(select(index.lessThan(first), index, first))
      last.assign(index.add(1))
    })
  })
  const [from, to] = GROWING_TOGETHER
  const layered = coverage.smoothstep(from, to).toConst() as Float
  return { base, top, layered, density, range: { first, last } }
}
