import { Fn, If, float, uv, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { CascadeNodes, CloudShadows, ShadowRayUniforms } from '../CloudShadowMap'
import { loop, type Float, type Vec2, type Vec3, type Vec4 } from '../tsl-types'
import { layerPair, type CloudSample } from './density'
import { forLayers, layerAt, type LayerNodes } from './layer'
import { FAR_AWAY } from './shells'

/** Samples of a ray through a layer. */
const STEPS = 12

/** Rays end this far from a cascade's plane, in its half widths: under a low sun they are long. */
const REACH = 1.2

/** How much finer than its texels a cascade sees the clouds. */
const SHARPNESS = 0.5

/** Where a ray crosses the sphere at an altitude, in multiples of its direction; equal if it does not. */
function crossings(
  field: CloudField,
  radial: Float,
  height: Float,
  altitude: Float
): { back: Float; front: Float; meets: Float } {
  const c = height.sub(altitude).mul(field.radius.mul(2).add(height).add(altitude))
  const discriminant = radial.mul(radial).sub(c).toConst()
  const root = discriminant.max(0).sqrt().toConst()
  return {
    back: radial.negate().sub(root).toConst(),
    front: root.sub(radial).toConst(),
    meets: discriminant.greaterThan(0).select(1, 0).toConst()
  }
}

/** The stretch of a sun ray in a layer that is nearest to the ray's start, in metres from there. */
function stretch(
  field: CloudField,
  { baseAltitude, thickness }: LayerNodes,
  radial: Float,
  height: Float,
  reach: Float
): { front: Float; back: Float } {
  const top = crossings(field, radial, height, baseAltitude.add(thickness))
  const base = crossings(field, radial, height, baseAltitude)
  const meetsBase = base.meets.greaterThan(0).toConst()
  // Through the shell down to its base, or by it; and beyond the base a second time.
  const firstBack = meetsBase.select(base.front, top.back).toConst() as Float
  const away = (front: Float, back: Float): Float => front.add(back).abs()
  const isSecond = meetsBase
    .and(away(base.back, top.back).lessThan(away(top.front, firstBack)))
    .toConst()
  return {
    front: isSecond.select(base.back, top.front).clamp(reach.negate(), reach).toConst(),
    back: isSecond.select(top.back, firstBack).clamp(reach.negate(), reach).toConst()
  }
}

/**
 * A texel of a cascade: what its sun ray meets on the stretch of it that is in the clouds and nearest to
 * the camera. Clouds are kept as one even stretch with the same optical depth, the same middle and the
 * same spread, by optical depth: thin clouds far above thick ones do not blur these.
 *
 * @returns Front towards the sun, against the cascade's plane [m]; mean extinction behind it [1/m];
 *   optical depth in all; optical depth of layers that cast shadows.
 * @see Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite" §5.9.4
 */
export function shadowRay(field: CloudField, ray: ShadowRayUniforms): Vec4 {
  return Fn(() => {
    const { view } = field
    const along = ray.toLight
    const at = uv().sub(0.5) as unknown as Vec2
    const start = ray.origin.add(ray.across.mul(at.x)).add(ray.along.mul(at.y)).toConst() as Vec3
    const radius = field.radius.add(view.height).toConst()
    const rise = start.dot(view.up).mul(radius).mul(2).add(start.dot(start)).toConst()
    const radiusThere = radius.mul(radius).add(rise).max(1).sqrt()
    const height = view.height.add(rise.div(radiusThere.add(radius))).toConst() as Float
    const radial = view.up.dot(along).mul(radius).add(start.dot(along)).toConst() as Float
    const reach = ray.halfWidth.mul(REACH).toConst() as Float
    const footprint = ray.halfWidth.mul((2 * SHARPNESS) / ray.size)
    const distance = footprint.div(field.pixelAngle).toConst() as Float
    /** Sums of optical depth, times place on the ray, and its square; of layers that cast shadows. */
    const sums = vec4(0).toVar() as Vec4
    const shortest = float(FAR_AWAY).toVar()
    forLayers(field, 'shadowLayer', index => {
      const layer = layerAt(field, index)
      const { front, back } = stretch(field, layer, radial, height, reach)
      const length = front.sub(back).max(0).div(STEPS).toConst() as Float
      const sampleAt = (steps: Float): CloudSample => {
        const offset = start.add(along.mul(front.sub(steps.mul(length)))).toConst() as Vec3
        return { offset, ...view.place(offset), distance }
      }
      If(length.greaterThan(0).and(layer.coverage.greaterThan(0)), () => {
        shortest.assign(shortest.min(length))
        loop('shadowPair', STEPS / 2, pair => {
          const middle = float(pair).mul(2).add(1).toConst() as Float
          const places = [middle.sub(0.5), middle.add(0.5)].map(at => at.toConst() as Float)
          const [first, second] = places.map(sampleAt)
          layerPair(field, layer, sampleAt(middle), [first, second], (extinction, i) => {
            const weighted = extinction.mul(length).toConst()
            const at = front.sub(places[i].mul(length)).toConst()
            const moment = weighted.mul(at).toConst()
            sums.addAssign(vec4(weighted, moment, moment.mul(at), weighted.mul(layer.shadow)))
          })
        })
      })
    })
    const depth = sums.x.toConst() as Float
    const mean = sums.y.div(depth.max(1e-6)).toConst() as Float
    const variance = sums.z.div(depth.max(1e-6)).sub(mean.mul(mean)).max(0)
    // Of an even stretch, the deviation is its length over √12.
    const half = variance.mul(3).sqrt().max(shortest.min(reach).mul(0.5)).max(1).toConst()
    return vec4(mean.add(half), depth.div(half.mul(2)), depth, sums.w)
  })()
}

/** Optical depths on the sun ray through a place, not scaled. */
export interface SunDepths {
  /** From the place to the sun. */
  toSun: Float
  /** Of all clouds on the ray. */
  through: Float
  /** Of all that cast shadows, from the place to the sun. */
  shadow: Float
  /** 1 where the map has the place; 0 where it does not, and the depths are 0. */
  known: Float
}

/** Parts of a cascade's width that are left out at its edges. */
const MARGIN = 0.02

/** Parts of its width in which a cascade gives way to the next. */
const FADE = 0.1

/**
 * The smallest cascade that holds a place answers.
 *
 * @param dither - Noise in [0, 1), in which cascades meet.
 */
export function sampleShadows(
  { map, cascades, count, shift }: CloudShadows,
  offset: Vec3,
  dither: Float
): SunDepths {
  const edge = dither
    .mul(-FADE)
    .add(0.5 - MARGIN)
    .toConst() as Float
  const from = (shift === undefined ? offset : offset.add(shift)).toConst()
  const place = vec4(0).toVar() as Vec4 & { assign: (n: Vec4) => void }
  // From the widest to the narrowest: the last that fits stays.
  for (const { u, v, w, isDrawn, square, halfWidth } of cascades.toReversed()) {
    const row = (r: CascadeNodes['u']): Float => r.xyz.dot(from).add(r.w)
    const at = vec2(row(u), row(v)).toConst() as Vec2
    const aside = at.sub(0.5).abs().toConst() as Vec2
    const above = row(w).toConst() as Float
    const isInside = aside.x
      .max(aside.y)
      .lessThan(edge)
      .and(above.abs().lessThan(halfWidth.mul(REACH - MARGIN)))
      .and(isDrawn.greaterThan(0))
    If(isInside, () => {
      place.assign(vec4(at.x.add(square).div(count), at.y, above, 1))
    })
  }
  const known = place.w.toConst() as Float
  const texel = map.sample(place.xy).level(0).mul(known).toConst() as Vec4
  const passed = texel.y.mul(texel.x.sub(place.z)).max(0).toConst() as Float
  const toSun = passed.min(texel.z).toConst() as Float
  const share = toSun.div(texel.z.max(1e-6))
  return { toSun, through: texel.z, shadow: texel.w.mul(share).toConst(), known }
}
