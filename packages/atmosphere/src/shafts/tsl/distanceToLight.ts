import type { Float } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'

/** Distance from the camera at which a ray leaves the planet's shadow; 0 where it begins in the light [m]. */
export function distanceToLight(
  { radius, toHorizon, cosLight }: Viewpoint,
  cosView: Float,
  cosViewLight: Float
): Float {
  const below = radius.mul(cosLight).toConst() as Float
  // Squares of the planet's radius and of the distance from the axis of its shadow, and half the growth of that.
  const depth = below.mul(below).sub(toHorizon).toConst() as Float
  const outward = radius.mul(cosView.sub(cosLight.mul(cosViewLight))).toConst() as Float
  const root = outward.mul(outward).add(cosViewLight.mul(cosViewLight).oneMinus().mul(depth))
  const leaves = depth.div(outward.add(root.max(0).sqrt()).max(1e-3))
  return cosLight.lessThan(0).and(depth.greaterThan(0)).select(leaves, 0).toConst()
}
