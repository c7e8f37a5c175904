import { atan, log2, smoothstep, vec2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { NOISE_SIZE } from '../noiseSizes'
import { latticeRotation } from '../lattice'
import {
  densityShape,
  REGION_PERIOD,
  SHAPE_WARP,
  WEATHER_AGAIN,
  WEATHER_WARP
} from '../layerUniforms'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import type { CloudSample } from './density'
import { rotate, type LayerNodes } from './layer'

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

const { edgeWidth, excess, meanEdge, regionContrast } = densityShape

/**
 * From the point of the ground below the camera to that below a sample, in the mapped space [m]:
 * (d − (h − h_c) u_c) R/r, which does not cancel.
 */
export function footOffset(field: CloudField, { offset, altitude }: CloudSample): Vec3 {
  const { up, height } = field.view
  const rise = altitude.sub(height)
  const scale = field.radius.div(field.radius.add(altitude))
  return offset.sub(up.mul(rise)).mul(scale)
}

/** Share of the sky that clouds cover around a place, from the world map or the large noise. */
function regionalCover(
  field: CloudField,
  layer: LayerNodes,
  region: Vec3,
  { up }: CloudSample,
  footprint: Float
): Float {
  const mapped = (): Float => {
    const across = up.xy.length().max(1e-6).toConst() as Float
    const longitude = atan(up.y, up.x.abs().max(1e-9).mul(up.x.lessThan(0).select(-1, 1)))
    // Geodetic, from the latitude on the sphere.
    const latitude = atan(up.z.mul(field.axialRatio), across)
    const uv = vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).add(0.5)
    // Meridians meet at the poles: a texel there is narrower.
    const texel = field.radius.mul(across).mul((2 * Math.PI) / field.worldMapWidth)
    const level = log2(footprint.div(texel).max(1))
    return field.worldMap!.sample(uv).level(level).x
  }
  const share = (field.worldMap === null ? region.z.mul(regionContrast).add(0.5) : mapped())
    .clamp(0, 1)
    .toConst() as Float
  // Odds multiply: 0 and 1 stay, and a coverage of ½ leaves the map as it is.
  const covered = share.mul(layer.coverage).toConst() as Float
  const clear = share.oneMinus().mul(layer.coverage.oneMinus())
  return covered.div(covered.add(clear).max(1e-6)).toConst()
}

/**
 * Weather of a layer at a place.
 *
 * The weather noise u takes every value in [0, 1] equally often, so u > 1 − c holds over the share c of
 * the sky. Samples too far apart to see single clouds read a blurred u: there the threshold becomes a
 * ramp, which keeps the mean.
 *
 * @param foot - `footOffset` of the sample. Twin: cpu/density.ts
 */
export function weatherAt(
  field: CloudField,
  layer: LayerNodes,
  foot: Vec3,
  sample: CloudSample
): CloudWeather {
  const turned = layer.turn(foot).toConst() as Vec3
  const footprint = sample.distance.mul(field.pixelAngle).toConst() as Float
  const regionPlace = rotate(latticeRotation.region, turned)
    .div(REGION_PERIOD)
    .add(layer.regionAnchor)
  const regionLevel = log2(footprint.mul(NOISE_SIZE.weather / REGION_PERIOD).max(1))
  const region = field.textures.weather
    .sample(regionPlace)
    .level(regionLevel)
    .xyz.sub(0.5)
    .toConst() as Vec3
  const share = regionalCover(field, layer, region, sample, footprint)
  const warp = region.mul(WEATHER_WARP).toConst() as Vec3
  const scale = layer.perWeatherPeriod
  const level = log2(footprint.mul(scale).mul(NOISE_SIZE.weather).max(1)).toConst() as Float
  const first = rotate(latticeRotation.weather, turned).add(warp).mul(scale)
  const second = rotate(latticeRotation.weatherAgain, turned)
    .add(warp)
    .mul(scale.div(WEATHER_AGAIN.period))
  const noise = field.textures.weather
    .sample(first.add(layer.weatherAnchor))
    .level(level)
    .sub(0.5)
    .toConst() as Vec4
  const again = field.textures.weather
    .sample(second.add(layer.weatherAgainAnchor))
    .level(level.sub(Math.log2(WEATHER_AGAIN.period)).max(0))
    .sub(0.5)
    .toConst() as Vec4
  const detailWarp = again.xyz.mul(SHAPE_WARP).toConst() as Vec3
  const z = noise.add(again.mul(WEATHER_AGAIN.weight)).dot(layer.weights)
  // Φ(z): as often as not near 0 and 1.
  const u = z.mul(-1.702).exp().add(1).reciprocal()
  const above = u.sub(1).add(share).toConst() as Float
  const spread = smoothstep(0.5, 4.5, level).toConst() as Float
  const tilt = share.mul(2).sub(1).toConst() as Float
  const surely = tilt.mul(tilt).mul(tilt.mul(tilt)).mul(tilt).mul(excess)
  const fill = layer.shapeAmount
    .mul(meanEdge)
    .add(above.div(edgeWidth))
    .add(surely)
    .toConst() as Float
  const cover = above.div(spread.max(0.02)).add(0.5).clamp(0, 1).toConst() as Float
  return {
    fill,
    cover,
    spread,
    shapeWarp: warp.add(detailWarp).toConst(),
    detailWarp
  }
}
