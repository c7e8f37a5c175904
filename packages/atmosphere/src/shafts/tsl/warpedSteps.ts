import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Ray } from '../../scattering/tsl/ray'
import type { Float } from '../../tsl-types'

/** 1/L of a level ray [1/height of the homogeneous atmosphere]. */
const LEVEL_RATE = 0.133

/** Growth of 1/L with the sine of the ray's slope where air is densest [1/height of the homogeneous atmosphere]. */
const SLOPE_RATE = 1.33

/** Positions of samples along a ray, by a part in [0, 1] of all of them. */
export interface WarpedSteps {
  /** Distance from the ray's start [m]. */
  distance(part: Float): Float
  /** Its derivative [m]. */
  slope(part: Float): Float
  /** Inverse of `distance`, for distances on the ray. */
  partAt(distance: Float): Float
}

/**
 * Spaces samples so that each has about as much light: q = (t − t_d)/(L + |t − t_d|) runs evenly, where t_d is
 * the distance at which the air is densest and L falls with the slope of the ray there. The tails are long
 * because molecules reach higher than aerosols.
 *
 * @param ray - View ray from its entry into the air.
 * @param length - > 0 [m].
 */
export function warpedSteps(
  { bottomRadius, homogeneousHeight }: AtmosphereUniforms,
  { altitude, cosView }: Ray,
  length: Float
): WarpedSteps {
  const radius = bottomRadius.add(altitude).toConst()
  const radial = radius.mul(cosView).toConst()
  const densest = radial.negate().clamp(0, length).toConst() as Float
  const steepness = radial.add(densest).abs().div(radius)
  const scale = homogeneousHeight.div(steepness.mul(SLOPE_RATE).add(LEVEL_RATE)).toConst() as Float
  const warp = (distance: Float): Float => {
    const from = distance.sub(densest).toConst()
    return from.div(from.abs().add(scale))
  }
  const first = densest.negate().div(densest.add(scale)).toConst() as Float
  const range = warp(length).sub(first).toConst() as Float
  const at = (part: Float): Float => first.add(range.mul(part)).toConst()
  return {
    distance(part) {
      const q = at(part)
      return densest.add(scale.mul(q).div(q.abs().oneMinus()))
    },
    slope(part) {
      const left = at(part).abs().oneMinus().toConst()
      return scale.mul(range).div(left.mul(left))
    },
    partAt(distance) {
      return warp(distance).sub(first).div(range).clamp()
    }
  }
}
