import type { Float } from '../../tsl-types'

/** x^(2ⁿ): squared n times. */
export const squared = (x: Float, times: number): Float =>
  times === 0 ? x : squared(x.mul(x).toConst(), times - 1)
