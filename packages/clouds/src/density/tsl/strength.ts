import { strengthForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import { cumulative } from '../../noise/tsl/noiseChannels'
import type { LayerNodes } from './layer'
import { squared } from './squared'
import type { Resolution } from './resolution'
import type { CloudWeather } from './weather'

/**
 * Strength of a column: how high its cloud can grow, before billows add to it.
 *
 * The weather's cumulative distribution u takes every value in [0, 1] equally often, so u > 1 − c holds
 * over the share c of the sky. There strength goes from 0 to `strongest`, whatever the coverage: few clouds
 * are as tall as many. An offset makes up for the billows, which add more at edges than they take.
 *
 * @param weather - Weather, whose sum has variance 1: u is its rank.
 * @param coverage - c, in [0, 1].
 */
export function columnStrength(
  layer: LayerNodes,
  { sum }: Pick<CloudWeather, 'sum'>,
  coverage: Float,
  { billowsLost: lost, unresolvedFraction }: Pick<Resolution, 'billowsLost' | 'unresolvedFraction'>
): Float {
  const { strongest, leastCoverage, offset, coverageOffset, fullCoverageExcess } = strengthForm
  const { smoothOffset, smoothUntil } = strengthForm
  const smooth = unresolvedFraction
    .mul(-1 / smoothUntil)
    .add(1)
    .max(0)
    .mul(smoothOffset)
  const forBillows = lost
    .mix(coverage.mul(coverageOffset).add(offset), smooth)
    .mul(layer.shapeAmount)
  return cumulative(sum)
    .sub(1)
    .add(coverage)
    .mul(strongest)
    .div(coverage.max(leastCoverage))
    .add(forBillows)
    .add(squared(coverage, 5).mul(fullCoverageExcess))
    .toConst()
}
