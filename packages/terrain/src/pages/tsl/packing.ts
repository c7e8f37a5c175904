import { vec2 } from 'three/tsl'
import type { Float, Vec2 } from '../../tsl-types'

/** Steps per unit of the first of the two packed numbers. */
const STEPS = 1024

/** Largest value of the second: below 1 in a float32 that has the first, too. */
const MOST = 1 - 2 ** -9

/**
 * Two numbers in one float32.
 *
 * @param first - To 1/1024.
 * @param second - In [0, 1], to 1/512.
 */
export const packed = (first: Float, second: Float): Float =>
  first.mul(STEPS).round().add(second.clamp(0, 1).mul(MOST))

/** Both numbers. */
export const unpacked = (both: Float): Vec2 => {
  const whole = both.floor().toConst()
  return vec2(whole.div(STEPS), both.sub(whole).div(MOST))
}
