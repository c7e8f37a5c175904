import { facingFit as fit } from '../../src/light/cpu/facing'
import type { CloudSourceSample } from './cloudLight'

/** Factor of light by its cosine on the faces of thick isolated clouds, in float64. Twin of the shader function. */
export function facing(sample: CloudSourceSample): number {
  const { depthToLight, depthThrough, layered, viewChord, resolved = 1, cosViewLight } = sample
  if (viewChord === undefined) return 1
  const weight =
    (depthThrough ** 4 / (depthThrough ** 4 + fit.thick ** 4)) * (1 - layered) * resolved
  const a = 1 / (depthToLight + fit.least)
  const b = 1 / (viewChord[0] + fit.least)
  const cosine = Math.min(Math.max(-cosViewLight, -fit.parallel), fit.parallel)
  const gradient = (a * a + b * b - 2 * a * b * cosine) / (1 - cosine ** 2)
  const onFace = a / Math.sqrt(Math.max(gradient, a * a))
  return Math.exp(weight * fit.cosine * (onFace - 0.5))
}
