import { If, float, smoothstep } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { strengthForm } from '../formConstants'
import { CLOUD_WARP, FIELD_WARP, FIELD_WEIGHT, REGION_CELLS } from '../../layers/layerUniforms'
import type { Float, Vec3 } from '../../tsl-types'
import type { LayerNodes } from './layer'
import type { CloudSample } from './sample'
import { squared } from './squared'
import { weatherNoise, type WeatherNoise } from './weatherNoise'
import { cumulative } from '../../noise/tsl/noiseChannels'

/** The weather of a layer at a place. */
export interface CloudWeather {
  /** Strength of the column: below 0 where it is clear, above 1 in the middle of clouds. */
  strength: Float
  /** Share of the sky that is covered, over the footprint of a sample; in [0, 1]. */
  filteredCoverage: Float
  /** Unresolved fraction: 0 where samples resolve single clouds, 1 where they see their mean only. */
  unresolvedFraction: Float
  /**
   * Shifts of the look-ups of shape and detail, in the layer's frame [m]: they too would repeat. Detail
   * is too fine for the steps of a filter that spreads kilometres.
   */
  shapeWarp: Vec3
  detailWarp: Vec3
}

/** Levels of detail by which a sample is coarser than single clouds, when these begin to be lost. */
const UNRESOLVED_LEVELS = [0.5, 4.5] as const

/** Share of a noise's variance that its levels of detail have lost. */
const lostShare = (level: Float): Float => smoothstep(0, strengthForm.fadeLevels, level)

/** Sum of the weather's noise on all scales, of mean 0 and variance 1 where nothing is blurred. */
const weatherSum = (layer: LayerNodes, { clouds, fields, regions, waves }: WeatherNoise): Float =>
  clouds
    .add(fields.mul(FIELD_WEIGHT))
    .dot(layer.weights)
    .add(fields.z.mul(layer.cells))
    .add(regions.z.add(regions.x.mul(REGION_CELLS)).mul(layer.regions))
    .add(
      waves.x
        .add(waves.y)
        .add(waves.z)
        .mul(layer.planet)
        .mul(Math.sqrt(2 / 3))
    )
    .toConst()

/** Variance of the weather's sum that levels of detail have lost: none near by. */
function lostVariance(
  layer: LayerNodes,
  { fieldLevel, regionLevel }: WeatherNoise,
  cloudLevel: Float
): Float {
  const regionVariance = layer.regions.mul(layer.regions).mul((1 + REGION_CELLS ** 2) / 12)
  const fieldVariance = layer.cloudVariance
    .add(layer.planet.mul(layer.planet))
    .add(regionVariance)
    .oneMinus()
  return layer.cloudVariance
    .mul(lostShare(cloudLevel))
    .add(fieldVariance.mul(lostShare(fieldLevel.sub(0.5))))
    .add(regionVariance.mul(lostShare(regionLevel.sub(0.8))))
}

/**
 * Strength of a column: how far cloud may fill it.
 *
 * The weather's cumulative distribution u takes every value in [0, 1] equally often, so u > 1 − c holds
 * over the share c of the sky. A map from (u, c) to strengths may stand here that depends on nothing else
 * but the layer, grows with both, and is `meanEdge` times the shape amount at u = 1 − c: that keeps what
 * a layer covers. `STEEPEST_WEATHER` of tsl/emptyDistance.ts bounds its slope.
 *
 * @param weather - Sum of variance 1: u is its rank.
 * @param coverage - c, in [0, 1].
 */
export function columnStrength(layer: LayerNodes, weather: Float, coverage: Float): Float {
  const tilt = coverage.mul(2).sub(1).toConst() as Float
  const surely = squared(tilt, 5).mul(tilt).mul(strengthForm.fullCoverageExcess)
  return layer.shapeAmount
    .mul(strengthForm.meanEdge)
    .add(cumulative(weather).sub(1).add(coverage).mul(layer.steepness))
    .add(surely)
    .toConst()
}

/**
 * Filtered coverage: the chance that blurred weather exceeds the threshold of its coverage, in [0, 1].
 * The variance of what is lost is known, which keeps the mean at any distance.
 */
function coverageOf(layer: LayerNodes, weather: Float, variance: Float, coverage: Float): Float {
  const { edgeSoftness, leastEdgeSoftness } = strengthForm
  const edges = layer.shapeAmount.mul(edgeSoftness).max(leastEdgeSoftness)
  const odds = coverage.clamp(1e-6, 1 - 1e-6).toConst() as Float
  const quantile = odds.div(odds.oneMinus()).log().div(1.702)
  const chance = cumulative(weather.add(quantile).div(variance.add(edges.mul(edges)).sqrt()))
  // Neither more nor less than all: the distribution has tails.
  const all = chance.sub(0.5).mul(1.002).add(0.5).clamp(0, 1)
  return coverage.greaterThan(0).select(all, 0)
}

/**
 * Weather of a layer at a place: a sum of noise on four scales, single clouds, the fields that they gather
 * in, regions, and the planet; and what a sample's footprint blurs of it.
 *
 * @param subpoint - `subpointOffset` of the sample.
 * @param where - Where the filtered coverage is wanted, which takes a third of the time: elsewhere it
 *   is 0. Twin: test/twins/density.ts
 */
export function weatherAt(
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  sample: CloudSample,
  where: 'everywhere' | 'where unresolved' = 'everywhere'
): CloudWeather {
  const noise = weatherNoise(field, layer, subpoint, sample)
  const { coverage, clouds, fields, level } = noise
  const sum = weatherSum(layer, noise)
  const cloudLevel = level.sub(layer.coarseness).toConst() as Float
  const unresolvedFraction = smoothstep(...UNRESOLVED_LEVELS, cloudLevel).toConst() as Float
  const variance = float(0).toVar()
  /** Blurred clouds are as many as sharp ones. */
  const sharpened = sum.toVar() as Float
  If(level.greaterThan(0), () => {
    variance.assign(lostVariance(layer, noise, cloudLevel))
    sharpened.mulAssign(variance.oneMinus().max(strengthForm.leastVariance).inverseSqrt())
  })
  const filteredCoverage = float(0).toVar()
  const filter = (): void => {
    filteredCoverage.assign(coverageOf(layer, sum, variance, coverage))
  }
  if (where === 'everywhere') filter()
  else If(unresolvedFraction.greaterThan(0), filter)

  const strength = columnStrength(layer, sharpened, coverage)
  const shapePeriod = layer.perShapePeriod.reciprocal().toConst()
  const detailWarp = clouds.xyz.mul(shapePeriod).mul(CLOUD_WARP).toConst() as Vec3
  const shapeWarp = detailWarp.add(fields.xyz.mul(shapePeriod).mul(FIELD_WARP)).toConst() as Vec3
  return { strength, filteredCoverage, unresolvedFraction, shapeWarp, detailWarp }
}
