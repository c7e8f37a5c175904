import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import type { Float } from '../../tsl-types'

/** A ray's line against the planet. */
export interface RadialRay {
  /** Projection of the start on the ray, from the planet's centre [m]. */
  readonly radial: Float
  /** Altitude of the start [m]. */
  readonly height: Float
}

/** A stretch of a ray of light: distances from its start towards the light, negative beyond it [m]. */
export interface LayerSegment {
  /** Its end nearest to the light. */
  readonly front: Float
  readonly back: Float
}

/** Crossings of a ray with the sphere at an altitude, in multiples of its direction; equal if there are none. */
function crossings(
  field: CloudField,
  { radial, height }: RadialRay,
  altitude: Float
): LayerSegment {
  const c = height.sub(altitude).mul(field.radius.mul(2).add(height).add(altitude))
  const root = radial.mul(radial).sub(c).max(0).sqrt().toConst()
  return {
    back: radial.negate().sub(root).toConst(),
    front: root.sub(radial).toConst()
  }
}

/**
 * Stretch of a ray of light in a layer, the one nearest to the ray's start.
 *
 * @param maximumDistance - Distance from the start, to either side [m].
 */
export function layerSegment(
  field: CloudField,
  { baseAltitude, thickness }: Pick<LayerNodes, 'baseAltitude' | 'thickness'>,
  ray: RadialRay,
  maximumDistance: Float
): LayerSegment {
  const top = crossings(field, ray, baseAltitude.add(thickness))
  const base = crossings(field, ray, baseAltitude)
  const meetsBase = base.front.greaterThan(base.back).toConst()
  // Through the shell down to its base, or by it; and beyond the base a second time.
  const firstBack = select(meetsBase, base.front, top.back).toConst() as Float
  const second = base.back.add(top.back).abs()
  const isSecond = meetsBase.and(second.lessThan(top.front.add(firstBack).abs())).toConst()
  const least = maximumDistance.negate()
  return {
    front: select(isSecond, base.back, top.front).clamp(least, maximumDistance).toConst(),
    back: select(isSecond, top.back, firstBack).clamp(least, maximumDistance).toConst()
  }
}
