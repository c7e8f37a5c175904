import { waveForm } from '../../layers/layerUniforms'
import type { Vec3 } from '../../tsl-types'

/**
 * sin x to 10⁻⁶. A GPU's own may be off by 2⁻¹¹, and by more beyond ±π: as the waves shift the regions, and
 * these all that is smaller, it would move clouds by metres, and otherwise on every GPU.
 */
export function sine(x: Vec3): Vec3 {
  // Folded into [−π/2, π/2], where a polynomial of least maximum error is good.
  const turns = x.div(2 * Math.PI).add(0.25)
  const fold = turns.fract().sub(0.5).abs().sub(0.25)
  const y = fold.mul(-2 * Math.PI).toConst() as Vec3
  const square = y.mul(y).toConst() as Vec3
  return square
    .mul(-1.8363654e-4)
    .add(8.3063252e-3)
    .mul(square)
    .sub(0.16664828)
    .mul(square)
    .add(0.99999662)
    .mul(y)
    .toConst()
}

/**
 * Three waves around the planet, each in [−1, 1]: the largest scale of the weather.
 *
 * @param zenith - In the frame that drifts with the layer, unit length.
 */
export const planetWaves = (zenith: Vec3): Vec3 =>
  sine(zenith.yzx.mul(waveForm.next).add(zenith.zxy.mul(waveForm.last)))
