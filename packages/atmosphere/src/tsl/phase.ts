import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec4 } from '../tsl-types'

/**
 * Phase function of molecules [1/sr].
 *
 * @param cosViewSun - ν, cosine of the scattering angle, in [−1, 1].
 */
export function rayleighPhase(cosViewSun: Float): Float {
  return cosViewSun
    .mul(cosViewSun)
    .add(1)
    .mul(3 / (16 * Math.PI))
}

/**
 * Phase function of aerosols, per wavelength [1/sr].
 *
 * @param cosViewSun - ν, cosine of the scattering angle, in [−1, 1].
 * @see Cornette & Shanks 1992. Twin: cpu/phase.ts
 */
export function miePhase(uniforms: AtmosphereUniforms, cosViewSun: Float): Vec4 {
  const { mieAsymmetry, miePhaseFactor } = uniforms
  const chord = mieAsymmetry.mul(mieAsymmetry).add(1).sub(mieAsymmetry.mul(cosViewSun).mul(2))
  const inverse = chord.max(1e-4).inverseSqrt().toConst()
  return miePhaseFactor
    .mul(cosViewSun.mul(cosViewSun).add(1))
    .mul(inverse.mul(inverse).mul(inverse))
}
