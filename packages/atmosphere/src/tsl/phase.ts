import { Fn, float } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import { layout, type Float } from '../tsl-types'

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
  ([cosViewSun, asymmetry, factor]: [Float, Float, Float]) => {
    const chord = asymmetry.mul(asymmetry).add(1).sub(asymmetry.mul(cosViewSun).mul(2))
    const squaredChord = chord.max(1e-4).toConst('squaredChord')
    return factor
      .mul(cosViewSun.mul(cosViewSun).add(float(1)))
      .div(squaredChord.mul(squaredChord.sqrt()))
  },
  layout('cornetteShanks', 'cosViewSun', 'asymmetry', 'factor')
)

/**
 * Phase function of aerosols [1/sr].
 *
 * @param cosViewSun - ν, cosine of the scattering angle, in [−1, 1].
 * @see Cornette & Shanks 1992. Twin: cpu/phase.ts
 */
export function miePhase(uniforms: AtmosphereUniforms, cosViewSun: Float): Float {
  return cornetteShanks(cosViewSun, uniforms.mieAsymmetry, uniforms.miePhaseFactor)
}
