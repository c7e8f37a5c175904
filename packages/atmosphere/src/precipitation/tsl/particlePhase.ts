import { exp } from 'three/tsl'
import type { Float } from '../../tsl-types'

/**
 * Phase function of a forward lobe, and an even part [1/sr].
 *
 * @param cosScatter - Cosine of the scattering angle.
 * @param concentration - κ of the lobe e^{−κ(1 − cos θ)} (Fisher 1953, "Dispersion on a sphere").
 * @param even - Share of the light that goes evenly into all directions.
 */
export function particlePhase(cosScatter: Float, concentration: number, even: number): Float {
  const peak = ((1 - even) * 2 * concentration) / (1 - Math.exp(-2 * concentration))
  const lobe = exp(cosScatter.sub(1).mul(concentration)).mul(peak)
  return lobe.add(even).mul(1 / (4 * Math.PI))
}
