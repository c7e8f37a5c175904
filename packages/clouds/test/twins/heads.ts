import { headsFit as fit } from '../../src/light/cpu/heads'
import type { CloudSourceSample } from './cloudLight'

/** Light among the heads of thick isolated clouds, in float64. Twin of the shader function. */
export function heads(sample: CloudSourceSample): {
  leak: CloudSourceSample
  facing: number
  glow: number
} {
  const { depthToLight, depthThrough, layered, viewChord, resolved = 1, cosViewLight } = sample
  if (viewChord === undefined) return { leak: sample, facing: 1, glow: 0 }
  const weight =
    (depthThrough ** 4 / (depthThrough ** 4 + fit.thick ** 4)) * (1 - layered) * resolved
  const shortened = (depth: number, scale: number): number =>
    depth + weight * (scale * Math.log1p(depth / scale) - depth)
  const toLight = shortened(depthToLight, fit.toLight)
  const through = toLight + shortened(Math.max(depthThrough - depthToLight, 0), fit.behind)
  const a = 1 / (depthToLight + fit.least)
  const b = 1 / (viewChord[0] + fit.least)
  const cosine = Math.min(Math.max(-cosViewLight, -fit.parallel), fit.parallel)
  const gradient = (a * a + b * b - 2 * a * b * cosine) / (1 - cosine ** 2)
  const onFace = a / Math.sqrt(Math.max(gradient, a * a))
  return {
    leak: {
      ...sample,
      depthToLight: toLight,
      depthThrough: through,
      depthAcross: (sample.depthAcross * through) / Math.max(depthThrough, 1e-4)
    },
    facing: Math.exp(weight * fit.cosine * (onFace - 0.5)),
    glow: weight * fit.glow
  }
}
