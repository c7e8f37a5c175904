import type { Float } from '../../tsl-types'

/** Sine of an angle in [0, π] from its cosine. */
export function sine(cosine: Float): Float {
  return cosine.mul(cosine).oneMinus().max(0).sqrt()
}

/** asinh of x > −10 or so: further down the plain form cancels. */
export function asinh(x: Float): Float {
  return x.mul(x).add(1).sqrt().add(x).log()
}

/** sinh. */
export function sinh(x: Float): Float {
  return x.exp().sub(x.negate().exp()).mul(0.5)
}
