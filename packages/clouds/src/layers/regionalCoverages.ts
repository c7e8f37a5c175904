import { MathUtils } from 'three'
import { strengthForm } from '../density/formConstants'
import { NOISE_SIZE } from '../noise/noiseSizes'
import type { CloudLayerParameters } from './CloudLayer'
import { layerForms, layerPeriods, weatherScales } from './layerUniforms'

/** Regions that are told apart: all are equally frequent. */
const REGIONS = 8

/** z of Φ(z), as `cumulative` of noise/tsl/noiseChannels.ts has it. */
const quantile = (share: number): number => Math.log(share / (1 - share)) / 1.702

/** Levels of detail over which blurring takes the variance of single clouds, as measured on the noise [octaves]. */
const BLUR_LEVELS = [-0.9, 4] as const

/**
 * Shares of the sky that a layer covers in regions of the planet that are equally frequent: the distribution of
 * `filteredCoverageAt` of density/tsl/weather.ts, of weather whose single clouds a footprint blurs.
 *
 * @param footprint - Wider than single clouds, narrower than the fields that they gather in [m].
 */
export function regionalCoverages(
  layer: CloudLayerParameters,
  footprint: number
): readonly number[] {
  const { edgeSoftness, leastEdgeSoftness, fadeLevels, levelsPerOctave, contrast } = strengthForm
  const { cloudVariance } = weatherScales(layer.weatherWeights, false, layer.openCells)
  const texel = layerPeriods(layer).weather / NOISE_SIZE.weather
  const octaves = Math.log2(Math.max(footprint / texel, 1)) - layerForms(layer).coarseness
  const level = levelsPerOctave * octaves
  const lostVariance = cloudVariance * MathUtils.smoothstep(level, 0, fadeLevels)
  const edges = Math.max(layer.shapeAmount * edgeSoftness, leastEdgeSoftness)
  const width = Math.sqrt(lostVariance + edges * edges)
  const median = quantile(MathUtils.clamp(layer.coverage, 1e-6, 1 - 1e-6))
  const spread = Math.sqrt(1 - cloudVariance * MathUtils.smoothstep(level, ...BLUR_LEVELS))
  return Array.from({ length: REGIONS }, (_, i) => {
    const weather = spread * quantile((i + 0.5) / REGIONS)
    const chance = 1 / (1 + Math.exp((-1.702 * (weather + median)) / width))
    return MathUtils.clamp(0.5 + (chance - 0.5) * contrast, 0, 1)
  })
}
