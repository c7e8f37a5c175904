import { Vector3, type Quaternion } from 'three'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import { billowForm, strengthForm } from '../../src/density/formConstants'
import { latticeRotations, layerRotation } from '../../src/density/lattice'
import {
  MESOSCALE_PER_REGIONS,
  MESOSCALE_WARP,
  noisePeriods,
  REGION_SIZE,
  weatherShifts,
  scaleWeights,
  waveForm,
  layerForms,
  layerPeriods,
  mapShift,
  weatherScales
} from '../../src/layers/layerUniforms'
import {
  bulge,
  crumbDensity,
  densityAtHeight,
  densityOf,
  edgeAt,
  meanColumn,
  neededStrength,
  seenShare,
  topBillows
} from '../../src/layers/meanColumn'
import { isStorm, stormRadius } from '../../src/layers/storms'
import { windAxis } from '../../src/layers/wind'
import { ENCODING_SCALE } from '../../src/noise/noiseRecipes'
import { NOISE_SIZE } from '../../src/noise/noiseSizes'
import type { Vec3Array } from './noise'
import type { NoiseTextures } from './noiseTextures'
import { fibreLevel, frayedDistance, stormAround, stormStrength, type StormThere } from './storm'
import { cycloneAround, frontsAndBelts } from './weatherSystems'

/** State of a field of clouds: what a `CloudField` tells its shaders. */
export interface CloudState {
  readonly layers: readonly CloudLayerParameters[]
  /** Rotation of each layer's noise: `CloudField.rotations`. */
  readonly rotations: readonly Quaternion[]
  readonly bottomRadius: number
  /** Zenith of the camera, where winds blow as given, in the mapped space; only shear needs it. */
  readonly zenith?: Vector3
  /** Angle between neighbouring samples [rad]. */
  readonly pixelAngle: number
  /** Scaled optical depth over optical depth [–]; 1 if it is left out. */
  readonly depthScale?: number
  /** Share of the sky that is covered, by longitude and geodetic latitude [rad]; if there is a map. */
  readonly worldMap?: (longitude: number, latitude: number) => number
  /** a/b of the ellipsoid; only the map needs it. */
  readonly axialRatio?: number
  /** Width of the map [texels]. */
  readonly worldMapWidth?: number
}

/** A layer's weather at a place: see `CloudWeather` of tsl/weather.ts. */
export interface CloudWeather {
  readonly sum: number
  /** Share of the sky that the layer covers there, as far as it is known without noise. */
  readonly coverage: number
  readonly filteredCoverage: number
  readonly unresolvedFraction: number
  /** Displacement of noise along the axes of its lattices [m]. */
  readonly shift: Vector3
  /** The nearest storm, in layers of storms: distances from the axes of its anvil and tower, and its radius [m]. */
  readonly storm: StormThere | undefined
}

const clamp = (x: number, low: number, high: number): number => Math.min(Math.max(x, low), high)

const smoothstep = (low: number, high: number, x: number): number => {
  const t = clamp((x - low) / (high - low), 0, 1)
  return t * t * (3 - 2 * t)
}

/** Level of detail for a footprint; 0 where texels are wider. */
const levelOf = (footprint: number, texel: number): number =>
  footprint > texel ? Math.log2(footprint / texel) : 0

/** Level of detail of the weather's noise for a footprint: `weatherLevel`. */
const weatherLevelOf = (footprint: number, texel: number): number =>
  strengthForm.levelsPerOctave * levelOf(footprint, texel)

/** Place in the periods of a noise look-up, of a point in the frame of a layer. */
function placeIn(inLayer: Vector3, lattice: Quaternion, period: number): Vec3Array {
  const { x, y, z } = inLayer.clone().applyQuaternion(lattice)
  return [x / period, y / period, z / period]
}

const shifted = ([x, y, z]: Vec3Array, by: readonly number[], factor: number): Vec3Array => [
  x + factor * by[0],
  y + factor * by[1],
  z + factor * by[2]
]

/** Noise of unit deviation from its encoded values. */
const decoded = (values: readonly number[]): number[] =>
  values.map(value => (value - 0.5) / ENCODING_SCALE)

/** Share of a noise's variance that its levels of detail have lost. */
const lostShare = (level: number): number => smoothstep(0, strengthForm.fadeLevels, level)

/** Φ(z) of the normal distribution to 0.01, as the shader has it. */
const cumulative = (z: number): number => 1 / (1 + Math.exp(-1.702 * z))

/** Share of the sky that a layer covers around a place, as far as it is known without noise. */
function coverageAt(
  state: CloudState,
  { coverage }: CloudLayerParameters,
  zenith: Vector3,
  shift: Vector3
): number {
  if (state.worldMap === undefined) return coverage
  const { x, y, z } = zenith
    .clone()
    .addScaledVector(shift, mapShift((2 * Math.PI) / (state.worldMapWidth ?? 2048)))
  const latitude = Math.atan2(z * (state.axialRatio ?? 1), Math.hypot(x, y))
  const share = clamp(state.worldMap(Math.atan2(y, x), latitude), 0, 1)
  const covered = share * coverage
  return covered / Math.max(covered + (1 - share) * (1 - coverage), 1e-6)
}

/** Waves around the planet, in [−1, 1]. */
function planetWaves({ x, y, z }: Vector3): Vec3Array {
  return [
    Math.sin(waveForm.next * y + waveForm.last * z),
    Math.sin(waveForm.next * z + waveForm.last * x),
    Math.sin(waveForm.next * x + waveForm.last * y)
  ]
}

/**
 * Float64 twin of `weatherBackground` and `cloudWeather`, in planet-centred coordinates without anchors.
 *
 * @param position - Displacement from the planet's centre, in the mapped space [m].
 * @param distance - Distance from the camera [m].
 * @param height - ĥ in the layer, by which columns lean, in [0, 1].
 * @param bendAt - Displacement by turbulence [m] of columns, by the shift of the layer's noise.
 */
export function weatherAt(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  position: Vector3,
  distance: number,
  height = 0,
  bendAt: (shift: Vector3) => readonly [number, number] = () => [0, 0]
): CloudWeather {
  const layer = state.layers[index]
  const ownRotation = state.rotations[index]
  const zenith = position.clone().normalize()
  const subpoint = zenith.clone().multiplyScalar(state.bottomRadius)
  const footprint = distance * state.pixelAngle
  const scales = weatherScales(layer.weatherWeights, state.worldMap !== undefined, layer.openCells)
  const coarseness = strengthForm.levelsPerOctave * layerForms(layer).coarseness
  const period = layerPeriods(layer).weather
  const sample = (place: Vec3Array, level: number): number[] =>
    noise.sample('weather', place, level).map(value => value - 0.5)
  const dot = (values: readonly number[]): number =>
    values.reduce((sum, value, i) => sum + value * scales.clouds[i], 0)

  const fromFirst = layerRotation(0).invert()
  const zenithThere = zenith.clone().applyQuaternion(state.rotations[0]).applyQuaternion(fromFirst)
  const waves = planetWaves(zenithThere)
  const cyclone = cycloneAround(zenithThere)
  const displacement = cyclone.displacement
    .clone()
    .applyQuaternion(layerRotation(0))
    .applyQuaternion(state.rotations[0].clone().invert())
    .multiplyScalar(state.bottomRadius)
  const source = subpoint.clone().add(displacement)
  const regionLevel = weatherLevelOf(footprint, noisePeriods.regions / NOISE_SIZE.weather)
  const region = sample(
    shifted(
      placeIn(
        source.clone().applyQuaternion(state.rotations[0]),
        latticeRotations.region,
        noisePeriods.regions
      ),
      waves,
      waveForm.warp
    ),
    regionLevel
  )
  const inLayer = subpoint.clone().applyQuaternion(ownRotation)
  const mesoscaleLevel = weatherLevelOf(footprint, noisePeriods.mesoscale / NOISE_SIZE.weather)
  const mesoscale = sample(
    shifted(
      placeIn(
        source.clone().applyQuaternion(ownRotation),
        latticeRotations.mesoscale,
        noisePeriods.mesoscale
      ),
      region,
      MESOSCALE_WARP
    ),
    mesoscaleLevel
  )
  const mesoscaleFactor = MESOSCALE_PER_REGIONS * scales.regions
  const fieldPeriod = period * noisePeriods.fields
  const fieldLevel = weatherLevelOf(footprint, fieldPeriod / NOISE_SIZE.weather)
  const fields = sample(
    shifted(placeIn(inLayer, latticeRotations.fields, fieldPeriod), region, weatherShifts.regions),
    fieldLevel
  )
  const [shiftX, shiftY] = [0, 1].map(
    axis => (weatherShifts.fields * fields[axis] + weatherShifts.regions * region[axis]) * period
  )
  const shift = new Vector3(shiftX, shiftY, (shiftX - shiftY) / Math.SQRT2)
  const coverage = coverageAt(state, layer, zenith, new Vector3(fields[2], fields[0], fields[1]))

  const lean = new Vector3()
  if (layer.shear !== 0) {
    if (state.zenith === undefined) throw new Error('CloudState: shear needs a zenith')
    windAxis(layer.wind, state.zenith, lean).cross(zenith).multiplyScalar(layer.shear)
  }
  const [bendX, bendY] = bendAt(shift)
  const rise = height * (layer.topAltitude - layer.baseAltitude)
  const subpointInLayer = subpoint.addScaledVector(lean, -rise).applyQuaternion(ownRotation)
  const bend = new Vector3(bendX, bendY, (bendX - bendY) / Math.SQRT2).add(shift).toArray()
  const level = weatherLevelOf(footprint, period / NOISE_SIZE.weather)
  const clouds = sample(
    shifted(placeIn(subpointInLayer, latticeRotations.weather, period), bend, 1 / period),
    level
  )

  const background =
    scaleWeights.fields * dot(fields) +
    scales.cells * fields[2] +
    mesoscaleFactor * (mesoscale[0] + scaleWeights.bands * mesoscale[3]) +
    scales.regions *
      (region[2] + scaleWeights.regionCells * region[0] + scaleWeights.regionBands * region[3]) +
    scales.planet * frontsAndBelts(zenithThere, waves, region, cyclone)
  const radius = stormRadius(layer, background, coverage, scales.clouds[2])
  const placeInFields = placeIn(subpointInLayer, latticeRotations.fields, fieldPeriod)
  const storm = isStorm(layer)
    ? stormAround(
        layer,
        shifted(placeInFields, bend, 1 / fieldPeriod),
        zenith.clone().applyQuaternion(ownRotation).applyQuaternion(latticeRotations.fields),
        lean.clone().applyQuaternion(ownRotation).applyQuaternion(latticeRotations.fields),
        radius,
        shifted(placeInFields, shift.toArray(), 1 / fieldPeriod)
      )
    : undefined
  const single = storm
    ? scales.clouds[2] * (storm.rank - 0.5) * Math.sqrt(1 - lostShare(level - coarseness))
    : dot(clouds)
  const blurred = background + single
  const lost =
    scales.cloudVariance * lostShare(level - coarseness) +
    scales.fieldVariance * lostShare(fieldLevel - 0.5) +
    (mesoscaleFactor ** 2 * (1 + scaleWeights.bands ** 2) * lostShare(mesoscaleLevel - 0.8)) / 12 +
    (scales.regions ** 2 * REGION_SIZE ** 2 * lostShare(regionLevel - 0.8)) / 12
  const variance = level > 0 ? lost : 0
  const { edgeSoftness, leastEdgeSoftness, leastVariance } = strengthForm
  const odds = clamp(coverage, 1e-6, 1 - 1e-6)
  const quantile = Math.log(odds / (1 - odds)) / 1.702
  const edges = Math.max(edgeSoftness * layer.shapeAmount, leastEdgeSoftness)
  const chance = cumulative((blurred + quantile) / Math.sqrt(variance + edges ** 2))
  return {
    sum: blurred / Math.sqrt(Math.max(1 - variance, leastVariance)),
    coverage,
    filteredCoverage: coverage > 0 ? clamp(0.5 + strengthForm.contrast * (chance - 0.5), 0, 1) : 0,
    unresolvedFraction: smoothstep(0.5, 4.5, level - coarseness),
    shift,
    storm: storm && { ...storm, radius }
  }
}

/** Strength of a column, before billows: tsl/strength.ts. */
function columnStrength(
  { shapeAmount }: CloudLayerParameters,
  { sum, coverage, unresolvedFraction }: CloudWeather,
  billowsLost: number
): number {
  const { strongest, leastCoverage, offset, coverageOffset, fullCoverageExcess } = strengthForm
  const { smoothOffset, smoothUntil } = strengthForm
  const smooth = smoothOffset * Math.max(1 - unresolvedFraction / smoothUntil, 0)
  const near = offset + coverageOffset * coverage
  const rank = cumulative(sum)
  return (
    (strongest * (rank - (1 - coverage))) / Math.max(coverage, leastCoverage) +
    shapeAmount * (near + billowsLost * (smooth - near)) +
    fullCoverageExcess * coverage ** 32
  )
}

/** Periods of the octaves of detail, in those of the first, and their amplitudes. */
const OCTAVES = [
  [1, 1],
  [1 / 5, 0.55],
  [1 / 25, 0.3]
] as const

/** Detail of unit deviation near by: tsl/billows.ts. */
function detailAt(
  noise: NoiseTextures,
  stretched: Vector3,
  period: number,
  footprint: number
): number {
  const width = footprint * billowForm.detailFootprints
  const [x, y, z] = placeIn(stretched, latticeRotations.detail, period)
  return OCTAVES.reduce((sum, [part, amplitude]) => {
    if (part < 1 && width >= (5 / 24) * part * period) return sum
    const level = levelOf(width, (part * period) / NOISE_SIZE.detail)
    const [value] = decoded(noise.sample('detail', [x / part, y / part, z / part], level))
    return sum + amplitude * value
  }, 0)
}

/** A layer at a place: `LayerSample` of tsl/sampleLayer.ts. */
export interface LayerSample {
  /** [1/m]. */
  readonly extinction: number
  /** Strength with all billows, less what the height needs [–]. */
  readonly strength: number
}

/**
 * Float64 twin of `sampleLayer`, in the weather of that very place.
 *
 * @param position - Displacement from the planet's centre, in the mapped space [m].
 * @param distance - Distance from the camera [m].
 */
export function sampleLayer(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  position: Vector3,
  distance: number,
  hasDetail: boolean
): LayerSample {
  const layer = state.layers[index]
  const { baseAltitude, topAltitude, density, shapeAmount, detailAmount } = layer
  const footprint = distance * state.pixelAngle
  const periods = layerPeriods(layer)
  const { stretch } = layerForms(layer)
  const thickness = topAltitude - baseAltitude
  const altitude = position.length() - state.bottomRadius
  const height = clamp((altitude - baseAltitude) / thickness, 0, 1)

  const stretched = position
    .clone()
    .applyQuaternion(state.rotations[index])
    .divide(new Vector3(stretch, stretch, 1))
  const level = levelOf(footprint * billowForm.footprints, periods.shape / NOISE_SIZE.shape)
  const billowsAt = (shift: Vector3): number[] => {
    const place = placeIn(stretched, latticeRotations.shape, periods.shape)
    const there = shifted(place, shift.toArray(), 1 / periods.shape)
    return decoded(noise.sample('shape', there, level))
  }
  const weather = weatherAt(state, noise, index, position, distance, height, shift => {
    const [, , x, y] = billowsAt(shift)
    const bend = layer.turbulence * billowForm.bend * Math.min(height / billowForm.bendHeight, 1)
    return [x * bend * periods.shape, y * bend * periods.shape]
  })
  const [coarse, fine] = billowsAt(weather.shift)

  const growing = (growth: number): number => 1 + growth * (2 * height - 1)
  const ofCoarse = shapeAmount * billowForm.coarse * growing(billowForm.coarseGrowth)
  const ofFine = shapeAmount * billowForm.fine * growing(billowForm.fineGrowth)
  const sign = Math.min(height / billowForm.wispHeight - 1, 1)
  const lost = smoothstep(...strengthForm.billowLevels, level)
  const unbillowed = columnStrength(layer, weather, lost)
  const rough = topBillows(unbillowed)
  const needed = neededStrength(layer, height)
  const inColumn = unbillowed - needed + bulge(ofCoarse * coarse * rough, unbillowed, needed)
  const share = clamp(1 + (inColumn - billowForm.fineFrom) / billowForm.fineOver, 0, 1)
  const ofDetail =
    shapeAmount * detailAmount * billowForm.detail * growing(billowForm.fineGrowth) * sign * share
  const storm = weather.storm && {
    ...weather.storm,
    unfrayed: weather.storm.distance,
    distance: frayedDistance(layer, weather.storm, height, place =>
      decoded(noise.sample('shape', place, fibreLevel(layer, weather.storm!.radius, level)))
    )
  }
  const parts = storm
    ? stormStrength(layer, storm, coarse, fine, height)
    : {
        strength: inColumn + ofFine * share * fine * rough,
        detail: ofDetail,
        edge: edgeAt(layer, height),
        crumbs: crumbDensity(unbillowed, needed)
      }
  let { strength } = parts
  const most = 2.5 * Math.abs(parts.detail)
  if (hasDetail && most > 0 && strength > -most && strength < parts.edge + most) {
    strength += parts.detail * detailAt(noise, stretched, periods.detail, footprint)
  }

  const atHeight = densityAtHeight(layer, height)
  const near = atHeight * densityOf(parts.edge, strength) * parts.crumbs
  const { unresolvedFraction, filteredCoverage } = weather
  if (unresolvedFraction === 0 || filteredCoverage === 0) {
    return { extinction: density * near, strength }
  }
  const depthScale = state.depthScale ?? 1
  const column = meanColumn(layer, depthScale)
  const { columnDensity, fullDensity } = column
  const meanDensity = columnDensity + filteredCoverage ** 32 * (fullDensity - columnDensity)
  const columnDepth = Math.max(density * thickness * depthScale * meanDensity, 1e-4)
  const passing = 1 - filteredCoverage * (1 - Math.exp(-columnDepth))
  const whole = -Math.log(Math.max(passing, 1e-30)) / depthScale / thickness / density
  const far = (whole * seenShare(layer, height)) / column.profileMean
  const through =
    (1 - unresolvedFraction) * Math.exp(-near * columnDepth) +
    unresolvedFraction * Math.exp(-far * columnDepth)
  const mixed = -Math.log(Math.max(through, 1e-30)) / columnDepth
  return { extinction: density * mixed, strength: Math.max(strength, 0) }
}

/**
 * Float64 twin of `cloudExtinction`.
 *
 * @param position - Displacement from the planet's centre, in the mapped space [m].
 * @param distance - Distance from the camera [m].
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
  return state.layers.reduce((sum, { baseAltitude, topAltitude, coverage }, index) => {
    if (altitude <= baseAltitude || altitude >= topAltitude || coverage === 0) return sum
    return sum + sampleLayer(state, noise, index, position, distance, detail).extinction
  }, 0)
}
