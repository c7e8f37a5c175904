import { select } from '../../select'
import type { Float, Vec4 } from '../../tsl-types'

/**
 * Difference of log₂ distances below which two pixels see the same surface: 7 %. Greater: clouds smear over what
 * stands before them; smaller: grain on slopes (*Shadows*).
 */
export const SAME_DISTANCE = 0.1

/**
 * Depth test of history and neighbours: whether another pixel's clouds are what this pixel would see. They
 * are if they lie in front of what both pixels end at, or if both end at the same distance.
 *
 * @param end - log₂ of the distance at which this pixel ends.
 * @param other - The other pixel's log₂ distances, of its clouds and of its end.
 * @returns 1 if it passes, else 0.
 */
export function passesDepthTest(end: Float, { x: distance, y: otherEnd }: Vec4): Float {
  const isBehind = end.min(otherEnd).greaterThan(distance)
  const isSame = end.sub(otherEnd).abs().lessThan(SAME_DISTANCE)
  return select(isBehind.or(isSame), 1, 0)
}
