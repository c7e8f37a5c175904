import type { Float } from '../../tsl-types'

/** Share by which reflectance has gone from that at normal incidence to 1: (1 − cos θ)⁵. */
export function schlick(cosine: Float): Float {
  const rest = cosine.oneMinus().clamp().toConst() as Float
  const square = rest.mul(rest).toConst() as Float
  return square.mul(square).mul(rest)
}
