import { int } from 'three/tsl'
import { fromBits, toBits, type Float, type Vec4 } from '../../tsl-types'

/** Bits of a float's mantissa that a half float lacks. */
const SPARE_BITS = 13

/**
 * Rounds to half floats at random, right in the mean: GPUs truncate, and history would darken with each
 * frame that it is copied.
 *
 * @param value - At least 0.
 * @param noise - In [0, 1).
 */
export function toHalf(value: Vec4, noise: Float): Vec4 {
  const carry = int(noise.mul(2 ** SPARE_BITS))
  return fromBits(
    toBits(value)
      .add(carry)
      .bitAnd(int(-(2 ** SPARE_BITS)))
  )
}
