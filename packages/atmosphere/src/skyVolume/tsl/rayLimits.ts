import type { Bool, Float } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'

/** Limits of a view ray: where it enters and leaves the air, or meets the ground. */
export interface RayLimits {
  /** Distance to where the air begins: 0 inside it [m]. */
  start: Float
  /** Distance from there to the ground or out of the air; 0 if the ray misses the air [m]. */
  length: Float
  /** True if the ray meets the ground. */
  hitsGround: Bool
}

/**
 * @param cosView - μ, ray against the zenith of the viewpoint.
 * @param forcedGround - True if the ray meets the ground, where rounding must not decide.
 */
export function rayLimits(viewpoint: Viewpoint, cosView: Float, forcedGround?: Bool): RayLimits {
  const radial = viewpoint.radius.mul(cosView).toConst()
  const square = radial.mul(radial).toConst()
  const ground = square.sub(viewpoint.toHorizon).toConst()
  const halfChord = square.add(viewpoint.toTop).max(0).sqrt().toConst()
  const start = radial.negate().sub(halfChord).max(0).toConst()
  const top = halfChord.sub(radial).max(0)
  const hitsGround = forcedGround ?? ground.greaterThanEqual(0).and(cosView.lessThan(0)).toConst()
  // The near root as c / (−b + √D): the other form cancels close to the ground.
  const bottom = viewpoint.toHorizon.div(ground.max(0).sqrt().sub(radial).max(1e-3))
  return {
    start: start,
    length: hitsGround.select(bottom, top).sub(start).max(0).toConst(),
    hitsGround
  }
}

/** Tests of a view ray against ground and air. */
export function rayTargets(
  viewpoint: Viewpoint,
  cosView: Float
): { hitsGround: Bool; meetsAir: Bool } {
  const radial = viewpoint.radius.mul(cosView)
  const square = radial.mul(radial).toConst()
  const looksDown = cosView.lessThan(0)
  const crosses = square.add(viewpoint.toTop).greaterThan(0).and(looksDown)
  return {
    hitsGround: square.greaterThanEqual(viewpoint.toHorizon).and(looksDown).toConst(),
    meetsAir: viewpoint.toTop.greaterThanEqual(0).or(crosses)
  }
}
