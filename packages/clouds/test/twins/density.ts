import { Vector3, type Quaternion } from 'three'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import { anvilForm, columnForm, erosionForm, strengthForm } from '../../src/density/formConstants'
import { latticeRotations } from '../../src/density/lattice'
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
  /** Rotation of each layer's noise: `CloudField.rotations`. */
  readonly rotations: readonly Quaternion[]
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
  readonly strength: number
  readonly filteredCoverage: number
  readonly unresolvedFraction: number
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
  layerRotation: Quaternion,
  latticeRotation: Quaternion,
  period: number,
  stretch = 1,
  warp = new Vector3()
): Vec3Array {
  const p = position.clone().applyQuaternion(layerRotation)
  p.set(p.x / stretch, p.y / stretch, p.z).addScaledVector(warp, 1 / stretch)
  p.applyQuaternion(latticeRotation).divideScalar(period)
  return [p.x, p.y, p.z]
}

/** Share of a noise's variance that its levels of detail have lost. */
const lostShare = (level: number): number => smoothstep(0, strengthForm.fadeLevels, level)

/** Φ(z) of the normal distribution to 0.01, as the shader has it. */
const cumulative = (z: number): number => 1 / (1 + Math.exp(-1.702 * z))

/** Share of the sky that a layer covers around a place, as far as it is known without noise. */
function coverageAt(
  state: CloudState,
  { coverage }: CloudLayerParameters,
  subpoint: Vector3,
  shift: Vector3
): number {
  if (state.worldMap === undefined) return coverage
  const { x, y, z } = subpoint
    .clone()
    .addScaledVector(shift, mapShift(state.worldMapWidth ?? 2048) * subpoint.length())
  const latitude = Math.atan2(z * (state.axialRatio ?? 1), Math.hypot(x, y))
  const share = clamp(state.worldMap(Math.atan2(y, x), latitude), 0, 1)
  const covered = share * coverage
  return covered / Math.max(covered + (1 - share) * (1 - coverage), 1e-6)
}

/** Waves around the planet, in [−1, 1]. */
function planetWaves(subpoint: Vector3, layerRotation: Quaternion): Vec3Array {
  const { x, y, z } = subpoint.clone().normalize().applyQuaternion(layerRotation)
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
  const layerRotation = state.rotations[index]
  const subpoint = position.clone().setLength(state.bottomRadius)
  const footprint = distance * state.pixelAngle
  const scales = weatherScales(layer.weatherWeights, state.worldMap !== undefined)
  const { steepness, coarseness } = layerForms(layer)

  const waves = planetWaves(subpoint, state.rotations[0])
  const shifted = (place: Vec3Array, by: readonly number[], factor: number): Vec3Array => {
    const [x, y, z] = place.map((p, axis) => p + by[axis] * factor)
    return [x, y, z]
  }
  const sample = (place: Vec3Array, level: number): number[] =>
    noise.sample('weather', place, level).map(value => value - 0.5)
  const regionPlace = placeIn(subpoint, state.rotations[0], latticeRotations.region, REGION_PERIOD)
  const regionLevel = levelOf(footprint, REGION_PERIOD / NOISE_SIZE.weather)
  const region = sample(shifted(regionPlace, waves, PLANET_WARP), regionLevel)

  const { weather: period, shape: shapePeriod } = layerPeriods(layer)
  const level = levelOf(footprint, period / NOISE_SIZE.weather)
  const fieldLevel = Math.max(level - Math.log2(FIELD_PERIOD), 0)
  const lookUp = (lattice: Quaternion, length: number, levelThere: number): number[] =>
    sample(
      shifted(placeIn(subpoint, layerRotation, lattice, length), region, WEATHER_WARP),
      levelThere
    )
  const fields = lookUp(latticeRotations.fields, period * FIELD_PERIOD, fieldLevel)
  const clouds = lookUp(latticeRotations.weather, period, level)
  const c = coverageAt(state, layer, subpoint, new Vector3(fields[2], fields[0], fields[1]))

  const dot = (values: number[]): number =>
    values.reduce((sum, value, i) => sum + value * scales.clouds[i], 0)
  const z =
    dot(clouds) +
    scales.fields * dot(fields) +
    scales.cells * fields[2] +
    scales.regions * (region[2] + REGION_CELLS * region[0]) +
    (scales.planet * (waves[0] + waves[1] + waves[2])) / Math.sqrt(1.5)
  const variance =
    scales.cloudVariance * lostShare(level - coarseness) +
    scales.fieldVariance * lostShare(fieldLevel - 0.5) +
    (scales.regions ** 2 * (1 + REGION_CELLS ** 2) * lostShare(regionLevel - 0.8)) / 12
  const odds = clamp(c, 1e-6, 1 - 1e-6)
  const quantile = Math.log(odds / (1 - odds)) / 1.702
  const { edgeSoftness, leastEdgeSoftness, leastVariance, fullCoverageExcess, meanEdge } =
    strengthForm
  const edges = Math.max(edgeSoftness * layer.shapeAmount, leastEdgeSoftness)
  const chance = cumulative((z + quantile) / Math.sqrt(variance + edges ** 2))
  const surely = fullCoverageExcess * (2 * c - 1) ** 33
  const sharp = z / Math.sqrt(Math.max(1 - variance, leastVariance))
  const detailWarp = new Vector3(clouds[0], clouds[1], clouds[2]).multiplyScalar(
    CLOUD_WARP * shapePeriod
  )
  return {
    strength: meanEdge * layer.shapeAmount + (cumulative(sharp) - (1 - c)) * steepness + surely,
    filteredCoverage: c > 0 ? clamp(0.5 + 1.002 * (chance - 0.5), 0, 1) : 0,
    unresolvedFraction: smoothstep(0.5, 4.5, level - coarseness),
    shapeWarp: new Vector3(fields[0], fields[1], fields[2])
      .multiplyScalar(FIELD_WARP * shapePeriod)
      .add(detailWarp),
    detailWarp
  }
}

/** What erosion leaves of a dimensional profile, before its edge is sharpened: tsl/erosion.ts. */
function erode(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  weather: CloudWeather,
  position: Vector3,
  distance: number,
  height: number,
  profile: number,
  detail: boolean
): number {
  const layer = state.layers[index]
  const layerRotation = state.rotations[index]
  const footprint = distance * state.pixelAngle
  const period = layerPeriods(layer).shape
  const { stretch } = layerForms(layer)
  const placeOf = (lattice: Quaternion, length: number, warp: Vector3): Vec3Array =>
    placeIn(position, layerRotation, lattice, length, stretch, warp)
  const place = placeOf(latticeRotations.shape, period, weather.shapeWarp)
  const level = levelOf(footprint, period / NOISE_SIZE.shape)
  const [whole, finer] = noise.sample('shape', place, level)
  const { finerBillows, filteredShape, fadeLevels, leastShape, mostDetail } = erosionForm
  const billows =
    whole + finerBillows * (finer - 0.5) + filteredShape * smoothstep(0, fadeLevels, level)
  const left = profile - layer.shapeAmount * Math.max(1 - billows, leastShape)
  const most = layer.detailAmount * mostDetail
  if (!detail) return left - most / 2
  const fine = placeOf(latticeRotations.detail, DETAIL_PERIOD, weather.detailWarp)
  const fineLevel = levelOf(footprint, DETAIL_PERIOD / NOISE_SIZE.detail)
  const [x, y, z] = fine.map(v => v / CURL_PERIOD)
  const curl = noise.sample('detail', [x, y, z], fineLevel).slice(1)
  const [a, b, c] = fine.map((v, axis) => v + (CURL_AMOUNT / CURL_SCALE) * (curl[axis] - 0.5))
  const [stirred] = noise.sample('detail', [a, b, c], fineLevel)
  const [wisps, heads] = erosionForm.wispHeights
  return left - most * (stirred + (1 - 2 * stirred) * smoothstep(wisps, heads, height))
}

/** Mean columns of clouds that are not seen one by one: tsl/unresolved.ts. */
function meanColumn(
  layer: CloudLayerParameters,
  { filteredCoverage }: CloudWeather
): { depth: number; density: number } {
  const { baseAltitude, topAltitude, density, profileExponent: e } = layer
  const { fibrous, anvil } = layerForms(layer)
  const [least, more, most] = columnForm.fibrousDensity
  const fibres = least + more * filteredCoverage ** 2 + most * filteredCoverage ** 64
  const solid = columnForm.density + anvil * (columnForm.anvilDensity - columnForm.density)
  const columnDensity = solid + fibrous * (fibres - solid)
  const depth = Math.max(density * (topAltitude - baseAltitude) * columnDensity, 1e-4)
  const passing = 1 - filteredCoverage * (1 - Math.exp(-depth))
  const effectiveDepth = -Math.log(Math.max(passing, 1e-30))
  const plainMean = (4 * e) / ((e + 1) * (2 * e + 1))
  const profileMean = plainMean + anvil * (anvilForm.profileMean - plainMean)
  return { depth, density: ((effectiveDepth / depth) * columnDensity) / profileMean }
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
  const [towerTop, anvilBase] = anvilForm.heights
  let sum = 0
  state.layers.forEach((layer, index) => {
    const { baseAltitude, topAltitude, density } = layer
    const height = (altitude - baseAltitude) / (topAltitude - baseAltitude)
    if (height <= 0 || height >= 1 || layer.coverage === 0) return
    const weather = weatherAt(state, noise, index, position, distance)
    const { strength, unresolvedFraction } = weather
    const { sharpness, anvil } = layerForms(layer)
    const anvilHere = anvil * smoothstep(towerTop, anvilBase, height)
    const usual = 1 - (2 * Math.max(height, 1e-4) ** layer.profileExponent - 1) ** 2
    const heightProfile = usual + anvilHere * (1 - smoothstep(0.9, 1, height) - usual)
    const narrowed = clamp(strength - anvilForm.narrowing * (anvil - anvilHere), 0, 1.3)
    const profile = narrowed * heightProfile
    const left = erode(state, noise, index, weather, position, distance, height, profile, detail)
    const column = meanColumn(layer, weather)
    const far = column.density * heightProfile * (1 - anvil + anvilHere)
    const near = clamp(left * sharpness, 0, 1)
    const through =
      (1 - unresolvedFraction) * Math.exp(-near * column.depth) +
      unresolvedFraction * Math.exp(-far * column.depth)
    const mixed =
      unresolvedFraction === 0 ? near : -Math.log(Math.max(through, 1e-30)) / column.depth
    sum += density * mixed * (1 + anvilHere * (anvilForm.density - 1))
  })
  return sum
}
