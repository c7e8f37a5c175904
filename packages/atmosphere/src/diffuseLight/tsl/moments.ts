import type { Float, Vec4 } from '../../tsl-types'

/** Constants of the real spherical harmonics up to degree 2. */
export const SH0 = Math.sqrt(1 / (4 * Math.PI))
export const SH1 = Math.sqrt(3 / (4 * Math.PI))
export const SH20 = Math.sqrt(5 / (16 * Math.PI))
export const SH21 = Math.sqrt(15 / (4 * Math.PI))
export const SH22 = Math.sqrt(15 / (16 * Math.PI))

/** The six moments of a field that is symmetric about the light's vertical plane. */
export interface Moments<T> {
  m00: T
  m10: T
  /** Over sin θ_s. */
  m11: T
  m20: T
  /** Over sin θ_s. */
  m21: T
  /** Over sin² θ_s. */
  m22: T
}

/**
 * The basis functions that go with {@link Moments}, for a direction v.
 *
 * With x towards the light's azimuth, v_x sin θ_s = ν − μ μ_s: dividing the moments by sin θ_s (once or
 * twice) and multiplying the basis by it leaves polynomials of the three cosines, smooth where the light
 * is at the zenith.
 *
 * @param cosView - μ, v against the zenith.
 * @param cosLight - μ_s, the light against the zenith.
 * @param cosViewLight - ν, v against the light.
 */
export function momentBasis(
  cosView: Float,
  cosLight: Float,
  cosViewLight: Float
): Omit<Moments<Float>, 'm00'> {
  const along = cosViewLight.sub(cosView.mul(cosLight)).toConst()
  const sinSquares = cosView.mul(cosView).oneMinus().mul(cosLight.mul(cosLight).oneMinus())
  return {
    m10: cosView.mul(SH1),
    m11: along.mul(SH1),
    m20: cosView.mul(cosView).mul(3).sub(1).mul(SH20),
    m21: cosView.mul(along).mul(SH21),
    m22: along.mul(along).mul(2).sub(sinSquares).mul(SH22)
  }
}

/**
 * Σ_l a_l Σ_m M_lm Y_lm: what a function with Legendre weights a_l makes of a field in a direction.
 *
 * @param weight1 - a₁/a₀.
 * @param weight2 - a₂/a₀.
 */
export function applyMoments(
  moments: Moments<Vec4>,
  basis: Omit<Moments<Float>, 'm00'>,
  weight1: Vec4 | number,
  weight2: Vec4 | number
): Vec4 {
  const first = moments.m10.mul(basis.m10).add(moments.m11.mul(basis.m11))
  const second = moments.m20
    .mul(basis.m20)
    .add(moments.m21.mul(basis.m21))
    .add(moments.m22.mul(basis.m22))
  return moments.m00.mul(SH0).add(first.mul(weight1)).add(second.mul(weight2))
}
