import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** c of the variable t = 1/(1 + cx) in which e^{x²} erfc x is fitted by a polynomial. */
export const ERFCX_SCALE = 0.54

/**
 * Coefficients of t, t², …, t⁷, fitted for the least relative error on [0, ∞). The first is c/√π, which
 * makes the polynomial exact at infinity; their sum is 1 and Σ k aₖ is 2/(c√π), which makes value and slope
 * exact at 0, where rays that rise and sink meet.
 */
export const ERFCX_COEFFICIENTS = [
  0.3046623751157883, 0.30451707395498484, 0.26423785324400206, 0.1361602041360286,
  0.19538177866143291, -0.29634625335349657, 0.0913869682412588
]

/** e^{x²} erfc x for x ≥ 0, within 7e-6: a polynomial in 1/(1 + cx), exact at 0, with its slope, and at ∞. */
export function erfcx(x: Float): Float {
  const t = x.mul(ERFCX_SCALE).add(1).reciprocal().toConst()
  const polynomial = ERFCX_COEFFICIENTS.reduceRight<Float>(
    (sum, coefficient) => sum.mul(t).add(coefficient),
    float(0)
  )
  return polynomial.mul(t)
}
