import { If, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec4 } from '../../tsl-types'

/**
 * Phase function of molecules [1/sr].
 *
 * @param cosViewLight - ν, cosine of the scattering angle, in [−1, 1].
 */
export function rayleighPhase(cosViewLight: Float): Float {
  return cosViewLight
    .mul(cosViewLight)
    .add(1)
    .mul(3 / (16 * Math.PI))
}

/**
 * Phase function of aerosols, per wavelength [1/sr].
 *
 * @param cosViewLight - ν, cosine of the scattering angle, in [−1, 1].
 * @see Cornette & Shanks 1992, "Physically reasonable analytic expression for the single-scattering phase
 *   function", Applied Optics 31, 3152, eq. 8. Twin: cpu/phase.ts
 */
export function miePhase(uniforms: AtmosphereUniforms, cosViewLight: Float): Vec4 {
  const { mieAsymmetry, mieIsGrey, miePhaseFactor } = uniforms
  const lobes = (asymmetry: Float | Vec4): Vec4 => {
    const chord = (asymmetry as Float).mul((asymmetry as Float).sub(cosViewLight.mul(2))).add(1)
    const root = chord.max(1e-4).inverseSqrt().toConst()
    return vec4(root.mul(root).mul(root).mul(cosViewLight.mul(cosViewLight).add(1)))
  }
  const phase = lobes(mieAsymmetry.x).toVar()
  If(mieIsGrey.equal(0), () => {
    phase.assign(lobes(mieAsymmetry))
  })
  return miePhaseFactor.mul(phase)
}
