import { Vector3, type Matrix3, type Quaternion } from 'three'
import type { CloudLayerParameters } from '../CloudLayer'
import { latticeRotation } from '../lattice'
import {
  CURL_AMOUNT,
  CURL_PERIOD,
  densityShape,
  DETAIL_PERIOD,
  layerPeriods,
  REGION_PERIOD,
  SHAPE_WARP,
  standardWeights,
  WEATHER_AGAIN,
  WEATHER_WARP
} from '../layerUniforms'
import { CURL_SCALE } from '../noiseRecipes'
import { NOISE_SIZE } from '../noiseSizes'
import type { Vec3Array } from './noise'
import type { NoiseTextures } from './noiseTextures'

/** Where the clouds are: what a `CloudField` tells its shaders. */
export interface CloudState {
  readonly layers: readonly CloudLayerParameters[]
  /** How each layer's noise is turned: `CloudField.turns`. */
  readonly turns: readonly Quaternion[]
  readonly bottomRadius: number
  /** Angle between neighbouring samples [rad]. */
  readonly pixelAngle: number
  /** Share of the sky that is covered, by longitude and geodetic latitude [rad]; if there is a map. */
  readonly worldMap?: (longitude: number, latitude: number) => number
  /** a/b of the ellipsoid; only the map needs it. */
  readonly axialRatio?: number
}

/** A layer's weather at a place: see `CloudWeather` of tsl/weather.ts. */
export interface CloudWeather {
  readonly fill: number
  readonly cover: number
  readonly spread: number
  readonly shapeWarp: Vector3
  readonly detailWarp: Vector3
}

const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high)

const smoothstep = (low: number, high: number, x: number): number => {
  const t = clamp((x - low) / (high - low), 0, 1)
  return t * t * (3 - 2 * t)
}

const levelOf = (footprint: number, texel: number): number =>
  Math.max(Math.log2(Math.max(footprint / texel, 1e-3)), 0)

/** Place in the periods of a noise look-up, from the planet's centre. */
function placeIn(
  position: Vector3,
  turn: Quaternion,
  rotation: Matrix3,
  period: number,
  warp = new Vector3()
): Vec3Array {
  const p = position.clone().applyQuaternion(turn).add(warp)
  p.applyMatrix3(rotation).divideScalar(period)
  return [p.x, p.y, p.z]
}

/**
 * Float64 twin of `weatherAt`, in planet-centred coordinates without anchors.
 *
 * @param position - From the planet's centre, in the mapped space [m].
 * @param distance - From the camera [m].
 */
export function weatherAt(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  position: Vector3,
  distance: number
): CloudWeather {
  const layer = state.layers[index]
  const turn = state.turns[index]
  const foot = position.clone().setLength(state.bottomRadius)
  const footprint = distance * state.pixelAngle
  const regionPlace = placeIn(foot, turn, latticeRotation.region, REGION_PERIOD)
  const region = noise
    .sample('weather', regionPlace, levelOf(footprint, REGION_PERIOD / NOISE_SIZE.weather))
    .slice(0, 3)
    .map(value => value - 0.5)
  let share = 0.5 + densityShape.regionContrast * region[2]
  if (state.worldMap !== undefined) {
    const across = Math.hypot(foot.x, foot.y)
    const latitude = Math.atan2(foot.z * (state.axialRatio ?? 1), across)
    share = clamp(state.worldMap(Math.atan2(foot.y, foot.x), latitude), 0, 1)
  }
  const covered = share * layer.coverage
  const clear = (1 - share) * (1 - layer.coverage)
  const c = covered / Math.max(covered + clear, 1e-6)

  const period = layerPeriods(layer).weather
  const level = levelOf(footprint, period / NOISE_SIZE.weather)
  const weights = standardWeights(layer.weatherWeights)
  const lookUp = (rotation: Matrix3, length: number, levelThere: number): number[] => {
    const [x, y, z] = placeIn(foot, turn, rotation, length).map(
      (coordinate, axis) => coordinate + (WEATHER_WARP * region[axis]) / length
    )
    return noise.sample('weather', [x, y, z], levelThere).map(value => value - 0.5)
  }
  const again = period * WEATHER_AGAIN.period
  const first = lookUp(latticeRotation.weather, period, level)
  const second = lookUp(
    latticeRotation.weatherAgain,
    again,
    level - Math.log2(WEATHER_AGAIN.period)
  )
  const z = weights.reduce(
    (sum, weight, i) => sum + weight * (first[i] + WEATHER_AGAIN.weight * second[i]),
    0
  )
  const detailWarp = new Vector3(second[0], second[1], second[2]).multiplyScalar(SHAPE_WARP)
  const shapeWarp = new Vector3(region[0], region[1], region[2]).multiplyScalar(WEATHER_WARP)
  const u = 1 / (1 + Math.exp(-1.702 * z))
  const above = u - (1 - c)
  const spread = smoothstep(0.5, 4.5, level)
  const { edgeWidth, excess, meanEdge } = densityShape
  const surely = excess * (2 * c - 1) ** 5
  return {
    fill: clamp(meanEdge * layer.shapeAmount + above / edgeWidth + surely, 0, 1.3),
    cover: clamp(0.5 + above / Math.max(spread, 0.02), 0, 1),
    spread,
    shapeWarp: shapeWarp.add(detailWarp),
    detailWarp
  }
}

/** What is left of a filled place when noise has carved it, before its edge is sharpened. */
function carved(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  weather: CloudWeather,
  position: Vector3,
  distance: number,
  height: number,
  filled: number,
  detail: boolean
): number {
  const layer = state.layers[index]
  const turn = state.turns[index]
  const footprint = distance * state.pixelAngle
  const period = layerPeriods(layer).shape
  const place = placeIn(position, turn, latticeRotation.shape, period, weather.shapeWarp)
  const [whole, finer] = noise.sample('shape', place, levelOf(footprint, period / NOISE_SIZE.shape))
  const heads = whole + 0.3 * (finer - 0.5)
  const left = filled - layer.shapeAmount * Math.max(1 - heads, densityShape.leastCarving)
  const most = layer.detailAmount * densityShape.erosion
  if (!detail) return left - most / 2
  const fine = placeIn(position, turn, latticeRotation.detail, DETAIL_PERIOD, weather.detailWarp)
  const level = levelOf(footprint, DETAIL_PERIOD / NOISE_SIZE.detail)
  const [x, y, z] = fine.map(v => v / CURL_PERIOD)
  const curl = noise.sample('detail', [x, y, z], level).slice(1)
  const [a, b, c] = fine.map((v, axis) => v + (CURL_AMOUNT / CURL_SCALE) * (curl[axis] - 0.5))
  const fray = noise.sample('detail', [a, b, c], level)[0]
  const wispy = smoothstep(0.1, 0.35, height)
  return left - most * (fray + (1 - 2 * fray) * wispy)
}

/**
 * Float64 twin of `cloudExtinction`.
 *
 * @param position - From the planet's centre, in the mapped space [m].
 * @param distance - From the camera [m].
 * @returns [1/m].
 */
export function cloudExtinction(
  state: CloudState,
  noise: NoiseTextures,
  position: Vector3,
  distance: number,
  detail: boolean
): number {
  const altitude = position.length() - state.bottomRadius
  const { carvedSharpness, farFill, smoothSharpness } = densityShape
  let sum = 0
  state.layers.forEach((layer, index) => {
    const { baseAltitude, topAltitude, density, shapeAmount } = layer
    const height = (altitude - baseAltitude) / (topAltitude - baseAltitude)
    if (height <= 0 || height >= 1 || layer.coverage === 0) return
    const weather = weatherAt(state, noise, index, position, distance)
    const { fill, cover, spread } = weather
    const profile = 1 - (2 * Math.max(height, 1e-4) ** layer.profileExponent - 1) ** 2
    const left = carved(
      state,
      noise,
      index,
      weather,
      position,
      distance,
      height,
      fill * profile,
      detail
    )
    const sharpness = smoothSharpness + (carvedSharpness - smoothSharpness) * shapeAmount ** 2
    const depth = Math.max(density * (topAltitude - baseAltitude) * farFill, 1e-4)
    const far = -Math.log(Math.max(1 - cover * (1 - Math.exp(-depth)), 1e-30)) / depth
    sum += density * ((1 - spread) * clamp(left * sharpness, 0, 1) + spread * far * profile)
  })
  return sum
}
