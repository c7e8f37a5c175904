import { float, vec2, vec3 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../CloudField'
import { strengthForm } from '../formConstants'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { cumulative } from '../../noise/tsl/noiseChannels'
import { inLattice } from './inLattice'
import type { LayerNodes } from './layer'
import { resolutionAt, type Resolution } from './resolution'
import { footprintOf, subpointOffset, zenithAt, type CloudSample } from './sample'
import { ifStorm, stormAround, stormNearby } from './storm'
import { stormRadius, type StormNearby } from './stormNearby'
import { unpackBackground, weatherBackground, type WeatherBackground } from './weatherBackground'

/** The weather of a layer at a place. */
export interface CloudWeather {
  /** Sum of the weather's noise on all scales, of mean 0 and variance 1; blurred clouds are as many as sharp ones. */
  readonly sum: Float
  /** Makes the share of the sky that is covered, over the footprint of a sample; in [0, 1]. */
  readonly filteredCoverage: () => Float
  /** In layers of storms, distances from the axes of the nearest anvil and the nearest tower, and their radius [m]; 0 in others. */
  readonly stormDistance: Float
  readonly towerDistance: Float
  readonly stormRadius: Float
  /** In layers of storms, `fibrePlace` and `fibreShare` of `StormAround` and the zenith there. */
  readonly fibrePlace: Vec3
  readonly fibreZenith: Vec3
  readonly fibreShare: Float
}

/** ln(c / (1 − c)) / 1.702 of a coverage c: z of Φ(z) = c. */
const quantileOf = (coverage: Float): Float => {
  const odds = coverage.clamp(1e-6, 1 - 1e-6).toConst() as Float
  return odds.div(odds.oneMinus()).log().div(1.702)
}

/**
 * Filtered coverage: the chance that blurred weather exceeds the threshold of its coverage, in [0, 1].
 * The variance of what is lost is known, which keeps the mean at any distance.
 */
function coverageOf(layer: LayerNodes, weather: Float, variance: Float, coverage: Float): Float {
  const { edgeSoftness, leastEdgeSoftness, contrast } = strengthForm
  const edges = layer.shapeAmount.mul(edgeSoftness).max(leastEdgeSoftness)
  const chance = cumulative(
    weather.add(quantileOf(coverage)).div(variance.add(edges.mul(edges)).sqrt())
  )
  // Neither more nor less than all: the distribution has tails.
  const all = chance.sub(0.5).mul(contrast).add(0.5).clamp()
  return select(coverage.greaterThan(0), all, 0)
}

/**
 * The storms nearest to a place, without turbulence.
 *
 * @param subpoint - As of `cloudWeather`.
 */
export const stormsAt = (
  field: CloudField,
  layer: LayerNodes,
  { sum, coverage, shift }: WeatherBackground,
  subpoint: Vec3
): StormNearby => {
  const radius = stormRadius(layer, sum, quantileOf(coverage))
  return stormNearby(layer, subpoint, zenithAt(field, subpoint), shift, radius)
}

/** Place of the ground that the column through a sample stands on: its subpoint, less the column's lean by the wind's shear [m]. */
export const footOf = (
  field: CloudField,
  layer: LayerNodes,
  sample: CloudSample,
  height: Float
): Vec3 =>
  subpointOffset(field, sample)
    .sub(layer.shearAxis.cross(sample.up).mul(height.mul(layer.thickness)))
    .toConst()

/**
 * Weather of a layer at a place: the background, and single clouds, one texture read; or the nearest storm.
 *
 * @param subpoint - `footOf` the sample.
 * @param bend - Displacement by turbulence [m].
 * @param nearby - In layers of storms, the nearest ones, if they are known: `stormsAt`.
 */
export function cloudWeather(
  field: CloudField,
  layer: LayerNodes,
  background: WeatherBackground,
  subpoint: Vec3,
  bend: Vec2,
  { weatherLevel: level, lostVariance, gain, cloudsLost }: Resolution,
  nearby?: StormNearby
): CloudWeather {
  const bent = bend.add(background.shift).toConst() as Vec2
  const single = float(0).toVar() as Float
  const stormDistance = float(0).toVar() as Float
  const towerDistance = float(0).toVar() as Float
  const radius = float(0).toVar() as Float
  const fibreShare = float(0).toVar() as Float
  const [fibrePlace, fibreZenith] = [0, 1].map(() => vec3(0).toVar() as Vec3)
  ifStorm(
    layer,
    () => {
      const found = nearby ?? stormsAt(field, layer, background, subpoint)
      const storm = stormAround(layer, subpoint, background.shift, bend, found)
      radius.assign(found.radius)
      stormDistance.assign(storm.distance)
      towerDistance.assign(storm.towerDistance)
      fibrePlace.assign(storm.fibrePlace)
      fibreZenith.assign(found.zenith)
      fibreShare.assign(storm.fibreShare)
      single.assign(storm.rank.sub(0.5).mul(layer.weights.z).mul(cloudsLost.oneMinus().sqrt()))
    },
    () => {
      const clouds = field.textures.weather
        .sample(layer.weatherLattice(subpoint).add(inLattice(bent).mul(layer.perWeatherPeriod)))
        .level(level)
        .sub(0.5)
      single.assign(clouds.dot(layer.weights))
    }
  )
  const blurred = single.add(background.sum).toConst() as Float
  const filteredCoverage = (): Float =>
    coverageOf(layer, blurred, lostVariance, background.coverage).toConst()
  const sum = blurred.mul(gain).toConst() as Float
  return {
    sum,
    filteredCoverage,
    stormDistance,
    towerDistance,
    stormRadius: radius,
    fibrePlace,
    fibreZenith,
    fibreShare
  }
}

/**
 * Filtered coverage of a layer around a place, in [0, 1]: all of the weather, without turbulence. Twin:
 * test/twins/density.ts
 *
 * @param subpoint - `subpointOffset` of the sample.
 */
export function filteredCoverageAt(
  field: CloudField,
  layer: LayerNodes,
  subpoint: Vec3,
  sample: CloudSample
): Float {
  if (field.extinction) return layer.coverage
  const footprint = footprintOf(field, sample)
  const packed = weatherBackground(field, layer, subpoint, sample, footprint)
  const background = unpackBackground(packed)
  const still = vec2(0) as Vec2
  const resolution = resolutionAt(layer, footprint)
  return cloudWeather(field, layer, background, subpoint, still, resolution).filteredCoverage()
}
