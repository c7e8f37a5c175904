import { Vector3, type Quaternion } from 'three'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import * as densityShape from '../../src/density/densityShape'
import { latticeRotation } from '../../src/density/lattice'
import {
  CURL_AMOUNT,
  CURL_PERIOD,
  DETAIL_PERIOD,
  FIELD_PERIOD,
  layerForms,
  layerPeriods,
  LAST_WAVES,
  mapShift,
  NEXT_WAVES,
  PLANET_WARP,
  REGION_CELLS,
  REGION_PERIOD,
  CLOUD_WARP,
  FIELD_WARP,
  WEATHER_WARP,
  weatherScales
} from '../../src/layers/layerUniforms'
import { CURL_SCALE } from '../../src/noise/noiseRecipes'
import { NOISE_SIZE } from '../../src/noise/noiseSizes'
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
  /** Width of the map [texels]. */
  readonly worldMapWidth?: number
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
  rotation: Quaternion,
  period: number,
  stretch = 1,
  warp = new Vector3()
): Vec3Array {
  const p = position.clone().applyQuaternion(turn)
  p.set(p.x / stretch, p.y / stretch, p.z).addScaledVector(warp, 1 / stretch)
  p.applyQuaternion(rotation).divideScalar(period)
  return [p.x, p.y, p.z]
}

/** Part of a noise's variance that its levels of detail have lost. */
const lost = (level: number): number => smoothstep(0, densityShape.blur, level)

/** Φ(z) of the normal distribution to 0.01, as the shader has it. */
const cumulative = (z: number): number => 1 / (1 + Math.exp(-1.702 * z))

/** Share of the sky that a layer covers around a place, as far as it is known without noise. */
function shareAt(
  state: CloudState,
  { coverage }: CloudLayerParameters,
  foot: Vector3,
  shift: Vector3
): number {
  if (state.worldMap === undefined) return coverage
  const { x, y, z } = foot
    .clone()
    .addScaledVector(shift, mapShift(state.worldMapWidth ?? 2048) * foot.length())
  const latitude = Math.atan2(z * (state.axialRatio ?? 1), Math.hypot(x, y))
  const share = clamp(state.worldMap(Math.atan2(y, x), latitude), 0, 1)
  const covered = share * coverage
  return covered / Math.max(covered + (1 - share) * (1 - coverage), 1e-6)
}

/** Waves around the planet, in [−1, 1]. */
function planetWaves(foot: Vector3, turn: Quaternion): Vec3Array {
  const { x, y, z } = foot.clone().normalize().applyQuaternion(turn)
  return [
    Math.sin(NEXT_WAVES * y + LAST_WAVES * z),
    Math.sin(NEXT_WAVES * z + LAST_WAVES * x),
    Math.sin(NEXT_WAVES * x + LAST_WAVES * y)
  ]
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
  const scales = weatherScales(layer.weatherWeights, state.worldMap !== undefined)
  const { steepness, coarseness } = layerForms(layer)

  const waves = planetWaves(foot, state.turns[0])
  const shifted = (place: Vec3Array, by: readonly number[], factor: number): Vec3Array => {
    const [x, y, z] = place.map((p, axis) => p + by[axis] * factor)
    return [x, y, z]
  }
  const sample = (place: Vec3Array, level: number): number[] =>
    noise.sample('weather', place, level).map(value => value - 0.5)
  const regionPlace = placeIn(foot, state.turns[0], latticeRotation.region, REGION_PERIOD)
  const regionLevel = levelOf(footprint, REGION_PERIOD / NOISE_SIZE.weather)
  const region = sample(shifted(regionPlace, waves, PLANET_WARP), regionLevel)

  const { weather: period, shape: shapePeriod } = layerPeriods(layer)
  const level = levelOf(footprint, period / NOISE_SIZE.weather)
  const fieldLevel = Math.max(level - Math.log2(FIELD_PERIOD), 0)
  const lookUp = (rotation: Quaternion, length: number, levelThere: number): number[] =>
    sample(shifted(placeIn(foot, turn, rotation, length), region, WEATHER_WARP), levelThere)
  const fields = lookUp(latticeRotation.fields, period * FIELD_PERIOD, fieldLevel)
  const clouds = lookUp(latticeRotation.weather, period, level)
  const c = shareAt(state, layer, foot, new Vector3(fields[2], fields[0], fields[1]))

  const dot = (values: number[]): number =>
    values.reduce((sum, value, i) => sum + value * scales.clouds[i], 0)
  const z =
    dot(clouds) +
    scales.fields * dot(fields) +
    scales.cells * fields[2] +
    scales.regions * (region[2] + REGION_CELLS * region[0]) +
    (scales.planet * (waves[0] + waves[1] + waves[2])) / Math.sqrt(1.5)
  const variance =
    scales.cloudVariance * lost(level - coarseness) +
    scales.fieldVariance * lost(fieldLevel - 0.5) +
    (scales.regions ** 2 * (1 + REGION_CELLS ** 2) * lost(regionLevel - 0.8)) / 12
  const odds = clamp(c, 1e-6, 1 - 1e-6)
  const quantile = Math.log(odds / (1 - odds)) / 1.702
  const { carvedBlur, leastBlur, leastVariance, excess, meanEdge } = densityShape
  const edges = Math.max(carvedBlur * layer.shapeAmount, leastBlur)
  const chance = cumulative((z + quantile) / Math.sqrt(variance + edges ** 2))
  const surely = excess * (2 * c - 1) ** 33
  const sharp = z / Math.sqrt(Math.max(1 - variance, leastVariance))
  const detailWarp = new Vector3(clouds[0], clouds[1], clouds[2]).multiplyScalar(
    CLOUD_WARP * shapePeriod
  )
  return {
    fill: meanEdge * layer.shapeAmount + (cumulative(sharp) - (1 - c)) * steepness + surely,
    cover: c > 0 ? clamp(0.5 + 1.002 * (chance - 0.5), 0, 1) : 0,
    spread: smoothstep(0.5, 4.5, level - coarseness),
    shapeWarp: new Vector3(fields[0], fields[1], fields[2])
      .multiplyScalar(FIELD_WARP * shapePeriod)
      .add(detailWarp),
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
  const { stretch } = layerForms(layer)
  const place = placeIn(position, turn, latticeRotation.shape, period, stretch, weather.shapeWarp)
  const level = levelOf(footprint, period / NOISE_SIZE.shape)
  const [whole, finer] = noise.sample('shape', place, level)
  const { leastCarving, lostCarving, shapeBlur } = densityShape
  const heads = whole + 0.3 * (finer - 0.5) + lostCarving * smoothstep(0, shapeBlur, level)
  const left = filled - layer.shapeAmount * Math.max(1 - heads, leastCarving)
  const most = layer.detailAmount * densityShape.erosion
  if (!detail) return left - most / 2
  const fine = placeIn(
    position,
    turn,
    latticeRotation.detail,
    DETAIL_PERIOD,
    stretch,
    weather.detailWarp
  )
  const fineLevel = levelOf(footprint, DETAIL_PERIOD / NOISE_SIZE.detail)
  const [x, y, z] = fine.map(v => v / CURL_PERIOD)
  const curl = noise.sample('detail', [x, y, z], fineLevel).slice(1)
  const [a, b, c] = fine.map((v, axis) => v + (CURL_AMOUNT / CURL_SCALE) * (curl[axis] - 0.5))
  const fray = noise.sample('detail', [a, b, c], fineLevel)[0]
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
  const {
    anvilDensity,
    anvilFill,
    anvilMean,
    anvilReach,
    solidFill,
    thinFibres,
    moreFibres,
    mostFibres
  } = densityShape
  let sum = 0
  state.layers.forEach((layer, index) => {
    const { baseAltitude, topAltitude, density } = layer
    const height = (altitude - baseAltitude) / (topAltitude - baseAltitude)
    if (height <= 0 || height >= 1 || layer.coverage === 0) return
    const weather = weatherAt(state, noise, index, position, distance)
    const { fill, cover, spread } = weather
    const { fibrous, sharpness, anvil } = layerForms(layer)
    const anvilHere = anvil * smoothstep(0.62, 0.8, height)
    const usual = 1 - (2 * Math.max(height, 1e-4) ** layer.profileExponent - 1) ** 2
    const profile = usual + anvilHere * (1 - smoothstep(0.9, 1, height) - usual)
    const filled = clamp(fill - anvilReach * (anvil - anvilHere), 0, 1.3) * profile
    const left = carved(state, noise, index, weather, position, distance, height, filled, detail)
    const fibres = thinFibres + moreFibres * cover ** 2 + mostFibres * cover ** 64
    const solid = solidFill + anvil * (anvilFill - solidFill)
    const columnFill = solid + fibrous * (fibres - solid)
    const depth = Math.max(density * (topAltitude - baseAltitude) * columnFill, 1e-4)
    const spreadDepth = -Math.log(Math.max(1 - cover * (1 - Math.exp(-depth)), 1e-30))
    const e = layer.profileExponent
    const plainMean = (4 * e) / ((e + 1) * (2 * e + 1))
    const profileMean = plainMean + anvil * (anvilMean - plainMean)
    const hidden = profile * (1 - anvil + anvilHere)
    const far = ((spreadDepth / depth) * columnFill) / profileMean
    const near = clamp(left * sharpness, 0, 1)
    const through =
      (1 - spread) * Math.exp(-near * depth) + spread * Math.exp(-far * hidden * depth)
    const matter = spread === 0 ? near : -Math.log(Math.max(through, 1e-30)) / depth
    sum += density * matter * (1 + anvilHere * (anvilDensity - 1))
  })
  return sum
}
