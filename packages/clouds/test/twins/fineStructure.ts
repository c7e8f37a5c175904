import { diffractedRow } from '../../../atmosphere/src/optics/cpu/diffractedRow'
import { dropletRow } from '../../../atmosphere/src/optics/cpu/dropletRow'
import { HALF_TEXELS, texelCosine } from '../../../atmosphere/src/optics/cpu/phaseRow'
import { scalePhase, type CloudPhaseParameters } from '../../src/light/cpu/cloudPhase'
import { aureolePhase, cloudPhase } from './cloudPhase'

/** Green of a phase function between its texels, by a search for the angle. */
function at(texels: Float32Array, cosine: number): number {
  let [low, high] = [0, 2 * HALF_TEXELS - 1]
  while (high - low > 1) {
    const middle = (low + high) >> 1
    if (texelCosine(middle) > cosine) low = middle
    else high = middle
  }
  const [a, b] = [low, high].map(i => Math.sqrt(Math.acos(Math.abs(texelCosine(i)))))
  const place = Math.sqrt(Math.acos(Math.min(Math.abs(cosine), 1)))
  const part = a === b ? 0 : (place - a) / (b - a)
  return texels[4 * low + 2] * (1 - part) + texels[4 * high + 2] * part
}

/**
 * Fine structure of droplets at the third wavelength: what was scattered once, and diffracted n times before or after. Twin of the shader function.
 *
 * @param radius - Radius of the droplets [µm].
 * @param depth - Optical depth from the light to the sample and on to the camera, not scaled.
 * @param depthToCamera - Its part from the sample to the camera, scaled.
 */
export function fineStructure(
  phase: CloudPhaseParameters,
  radius: number,
  cosine: number,
  depth: number,
  depthToCamera: number
): number {
  const { texels } = dropletRow(radius)
  const { depthScale } = scalePhase(phase)
  const lobes = cloudPhase(phase, cosine)
  const towards = Math.min(Math.max(10 * cosine - 9, 0), 1)
  const smooth = lobes + (aureolePhase(phase, cosine, depth * depthScale) - lobes) * towards
  const over = (row: Float32Array): number => at(row, cosine) - smooth
  // Poisson: none, and at least one diffraction among the other half of events that did not happen.
  const none = Math.exp(-depth)
  const some = Math.exp(-depth / 2) * (1 - Math.exp(-depth / 2))
  const source = none * over(texels) + some * over(diffractedRow(texels, radius))
  return (source * phase.scatteringAlbedo * Math.exp(depthToCamera)) / depthScale
}
