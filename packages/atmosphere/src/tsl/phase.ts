import { If, vec4 } from 'three/tsl'
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
  const { mieAsymmetry, mieIsGrey, miePhaseFactor } = uniforms
  const inverse = <T extends Float | Vec4>(asymmetry: T): T => {
    const chord = asymmetry.mul(asymmetry.sub(cosViewSun.mul(2))).add(1)
    const root = chord.max(1e-4).inverseSqrt().toConst()
    return root.mul(root).mul(root) as unknown as T
  }
  const lobes = cosViewSun.mul(cosViewSun).add(1).toConst()
  const phase = vec4(inverse(mieAsymmetry.x).mul(lobes)).toVar()
  If(mieIsGrey.lessThan(0.5), () => {
    phase.assign(inverse(mieAsymmetry as Vec4).mul(lobes))
  })
  return miePhaseFactor.mul(phase)
}
