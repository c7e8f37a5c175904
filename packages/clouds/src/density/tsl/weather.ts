import { If, atan, float, int, log2, smoothstep, vec2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { blur, carvedBlur, excess, leastBlur, leastVariance, meanEdge } from '../densityShape'
import { NOISE_SIZE } from '../../noise/noiseSizes'
import { latticeRotation } from '../lattice'
import {
  FIELD_PERIOD,
  FIELD_WEIGHT,
  LAST_WAVES,
  mapShift,
  NEXT_WAVES,
  PLANET_WARP,
  REGION_CELLS,
  REGION_PERIOD,
  CLOUD_WARP,
  FIELD_WARP,
  WEATHER_WARP
} from '../../layers/layerUniforms'
import type { Float, LevelTexture, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { layerAt, rotate, type LayerNodes } from './layer'
import type { CloudSample } from './sample'
import { cumulative } from '../../noise/tsl/noiseChannels'

/** What the weather says of a place in a layer. */
export interface CloudWeather {
  /** How far cloud may fill the layer: below 0 where it is clear, above 1 in the middle of clouds. */
  fill: Float
  /** Share of the sky that is covered, over the footprint of a sample; in [0, 1]. */
  cover: Float
  /** 0 where samples resolve single clouds, 1 where they see only `cover`. */
  spread: Float
  /**
   * Shifts of the look-ups of shape and detail, in the layer's frame [m]: they too would repeat. Detail
   * is too fine for the steps of a filter that spreads kilometres.
   */
  shapeWarp: Vec3
  detailWarp: Vec3
}

/** Share of the sky that the world map has covered around a place, in the direction of `up`. */
function mappedShare(
  field: CloudField,
  worldMap: LevelTexture<Vec2>,
  up: Vec3,
  footprint: Float
): Float {
  const across = up.xy.length().max(1e-6).toConst() as Float
  const longitude = atan(up.y, up.x.abs().max(1e-9).mul(up.x.lessThan(0).select(-1, 1)))
  // Geodetic, from the latitude on the sphere.
  const latitude = atan(up.z.mul(field.axialRatio), across)
  const uv = vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).add(0.5)
  // Meridians meet at the poles: a texel there is narrower.
  const texel = field.radius.mul(across).mul((2 * Math.PI) / field.worldMapWidth)
  return worldMap.sample(uv).level(log2(footprint.div(texel).max(1))).x
}

/**
 * Share of the sky that a layer covers around a place, as far as it is known without noise.
 *
 * @param shift - Of the look-up of the map, from the fields of the weather: it hides the shapes of the
 *   map's texels from near, and is gone where fields are too small to be seen.
 */
function shareAt(
  field: CloudField,
  layer: LayerNodes,
  { up }: CloudSample,
  footprint: Float,
  shift: Vec3
): Float {
  if (field.worldMap === null) return layer.coverage
  const there = up.add(shift.mul(mapShift(field.worldMapWidth))).toConst() as Vec3
  const share = mappedShare(field, field.worldMap, there, footprint).clamp(0, 1).toConst() as Float
  // Odds multiply: 0 and 1 stay, and a coverage of ½ leaves the map as it is.
  const covered = share.mul(layer.coverage).toConst() as Float
  const clear = share.oneMinus().mul(layer.coverage.oneMinus())
  return covered.div(covered.add(clear).max(1e-6)).toConst()
}

/** x squared, that squared, and so on. */
export const squared = (x: Float, times: number): Float =>
  times === 0 ? x : squared(x.mul(x).toConst(), times - 1)

/** Part of a noise's variance that its levels of detail have lost. */
const lost = (level: Float): Float => smoothstep(0, blur, level)

/**
 * sin x to 10⁻⁶. A GPU's own may be off by 2⁻¹¹, and by more beyond ±π: as the waves shift the regions, and
 * these all that is smaller, it would move clouds by metres, and otherwise on every GPU.
 */
function sine(x: Vec3): Vec3 {
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
 * Weather of a layer at a place.
 *
 * The weather is a sum of noise on four scales: clouds, the fields that they gather in, regions, and the
 * planet. Its cumulative distribution u takes every value in [0, 1] equally often, so u > 1 − c holds over
 * the share c of the sky. Of noise that a sample's footprint blurs, the variance is known: the cover is
 * the chance that the sum exceeds the same threshold, which keeps the mean at any distance.
 *
 * @param foot - `footOffset` of the sample.
 * @param where - Where its cover is wanted, which takes a third of the time: elsewhere it is 0.
 *   Twin: test/twins/density.ts
 */
export function weatherAt(
  field: CloudField,
  layer: LayerNodes,
  foot: Vec3,
  sample: CloudSample,
  where: 'everywhere' | 'where spread' = 'everywhere'
): CloudWeather {
  const { weather } = field.textures
  const turned = layer.turn(foot).toConst() as Vec3
  const footprint = sample.distance.mul(field.pixelAngle).toConst() as Float

  // Layers share their weather systems: where one is clear, others are.
  const isAlone = field.layers.length === 1
  const systems = isAlone ? layer : layerAt(field, int(0))
  const around = isAlone ? turned : (systems.turn(foot).toConst() as Vec3)
  const zenith = systems.turn(sample.up).toConst() as Vec3
  const waves = sine(zenith.yzx.mul(NEXT_WAVES).add(zenith.zxy.mul(LAST_WAVES)))
  const regionLevel = log2(footprint.mul(NOISE_SIZE.weather / REGION_PERIOD).max(1)).toConst()
  const region = weather
    .sample(
      rotate(latticeRotation.region, around)
        .div(REGION_PERIOD)
        .add(systems.regionAnchor)
        .add(waves.mul(PLANET_WARP))
    )
    .level(regionLevel)
    .xyz.sub(0.5)
    .toConst() as Vec3

  const warp = region.mul(WEATHER_WARP).toConst() as Vec3
  const scale = layer.perWeatherPeriod
  const level = log2(footprint.mul(scale).mul(NOISE_SIZE.weather).max(1)).toConst() as Float
  const fieldLevel = level.sub(Math.log2(FIELD_PERIOD)).max(0).toConst() as Float
  const fields = weather
    .sample(
      rotate(latticeRotation.fields, turned)
        .mul(scale.div(FIELD_PERIOD))
        .add(layer.fieldAnchor)
        .add(warp)
    )
    .level(fieldLevel)
    .sub(0.5)
    .toConst() as Vec4
  const share = shareAt(field, layer, sample, footprint, fields.zxy)
  const clouds = weather
    .sample(rotate(latticeRotation.weather, turned).mul(scale).add(layer.weatherAnchor).add(warp))
    .level(level)
    .sub(0.5)
    .toConst() as Vec4

  const z = clouds
    .add(fields.mul(FIELD_WEIGHT))
    .dot(layer.weights)
    .add(fields.z.mul(layer.cells))
    .add(region.z.add(region.x.mul(REGION_CELLS)).mul(layer.regions))
    .add(
      waves.x
        .add(waves.y)
        .add(waves.z)
        .mul(layer.planet)
        .mul(Math.sqrt(2 / 3))
    )
    .toConst() as Float
  const cloudLevel = level.sub(layer.coarseness).toConst() as Float
  const spread = smoothstep(0.5, 4.5, cloudLevel).toConst() as Float
  /** Of the weather that levels of detail have lost: none near by. */
  const variance = float(0).toVar()
  /** Blurred clouds are as many as sharp ones. */
  const sharp = z.toVar() as Float
  If(level.greaterThan(0), () => {
    const regionVariance = layer.regions.mul(layer.regions).mul((1 + REGION_CELLS ** 2) / 12)
    const fieldVariance = layer.cloudVariance
      .add(layer.planet.mul(layer.planet))
      .add(regionVariance)
      .oneMinus()
    variance.assign(
      layer.cloudVariance
        .mul(lost(cloudLevel))
        .add(fieldVariance.mul(lost(fieldLevel.sub(0.5))))
        .add(regionVariance.mul(lost(regionLevel.sub(0.8))))
    )
    sharp.mulAssign(variance.oneMinus().max(leastVariance).inverseSqrt())
  })
  const cover = float(0).toVar()
  const findCover = (): void => {
    const edges = layer.shapeAmount.mul(carvedBlur).max(leastBlur)
    const odds = share.clamp(1e-6, 1 - 1e-6).toConst() as Float
    const quantile = odds.div(odds.oneMinus()).log().div(1.702)
    const chance = cumulative(z.add(quantile).div(variance.add(edges.mul(edges)).sqrt()))
    // Neither more nor less than all: the distribution has tails.
    const all = chance.sub(0.5).mul(1.002).add(0.5).clamp(0, 1)
    cover.assign(share.greaterThan(0).select(all, 0))
  }
  if (where === 'everywhere') findCover()
  else If(spread.greaterThan(0), findCover)

  const tilt = share.mul(2).sub(1).toConst() as Float
  const surely = squared(tilt, 5).mul(tilt).mul(excess)
  const fill = layer.shapeAmount
    .mul(meanEdge)
    .add(cumulative(sharp).sub(1).add(share).mul(layer.steepness))
    .add(surely)
    .toConst() as Float
  const shapePeriod = layer.perShapePeriod.reciprocal().toConst()
  const detailWarp = clouds.xyz.mul(shapePeriod).mul(CLOUD_WARP).toConst() as Vec3
  return {
    fill,
    cover,
    spread,
    shapeWarp: detailWarp.add(fields.xyz.mul(shapePeriod).mul(FIELD_WARP)).toConst(),
    detailWarp
  }
}
