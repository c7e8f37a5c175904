import { Fn } from 'three/tsl'
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

const cornetteShanks = /*#__PURE__*/ Fn(
  ([cosViewSun, asymmetry, factor]: [Float, Vec4, Vec4]) => {
    const chord = asymmetry.mul(asymmetry).add(1).sub(asymmetry.mul(cosViewSun).mul(2))
    const squaredChord = chord.max(1e-4).toConst('squaredChord')
    return factor.mul(cosViewSun.mul(cosViewSun).add(1)).div(squaredChord.mul(squaredChord.sqrt()))
  },
  {
    name: 'cornetteShanks',
    type: 'vec4',
    inputs: [
      { name: 'cosViewSun', type: 'float' },
      { name: 'asymmetry', type: 'vec4' },
      { name: 'factor', type: 'vec4' }
    ]
  }
)

/**
 * Phase function of aerosols, per wavelength [1/sr].
 *
 * @param cosViewSun - ν, cosine of the scattering angle, in [−1, 1].
 * @see Cornette & Shanks 1992. Twin: cpu/phase.ts
 */
export function miePhase(uniforms: AtmosphereUniforms, cosViewSun: Float): Vec4 {
  return cornetteShanks(cosViewSun, uniforms.mieAsymmetry, uniforms.miePhaseFactor)
}
