import { MathUtils, Vector3 } from 'three'
import { stormPlaces } from '../../src/density/stormForm'
import { stormCell } from '../../src/layers/storms'
import {
  columnForm,
  extinctionForm,
  fallForm,
  streakBound,
  STRONGEST
} from '../../src/precipitation/fallForm'
import type { CloudLayerParameters } from '../../src/layers/CloudLayer'
import { dry } from '../../src/layers/precipitation'
import { windAxis } from '../../src/layers/wind'
import { weatherAt, type CloudState } from './density'
import type { NoiseTextures } from './noiseTextures'

/** Steps of the integral along a drop's path. */
const STEPS = 4000

/** Visible extinction [1/m] of precipitation: rates of water [mm/h], share of snow. */
export function extinctionOf(rate: number, snow: number, hail: number): number {
  const { rain, snow: flakes, hail: stones } = extinctionForm
  const perKm =
    (1 - snow) * rain[0] * rate ** rain[1] + snow * flakes[0] * rate ** flakes[1] + stones * hail
  return perKm / 1000
}

/** Share of snow at an altitude [m]: none from a depth of `melting` below the freezing level on, by Hermite's cubic. */
export function snowShareOf(altitude: number, freezingLevel: number): number {
  return 1 - MathUtils.smoothstep(freezingLevel - altitude, 0, fallForm.melting)
}

/** Rates of water that fall from a layer as drops or flakes, and as hail [mm/h], and the share of snow. */
export interface FallenOf {
  rate: number
  hail: number
  snow: number
}

/**
 * Precipitation under a column of a rank at an altitude [m], without streaks: `fallenFrom` of tsl/fall.ts.
 *
 * It sets in over a part of the layer above its base, evaporates below it, and is in part hail under the strongest columns.
 */
export function fallenOf(layer: CloudLayerParameters, rank: number, altitude: number): FallenOf {
  const { baseAltitude: base, topAltitude: top } = layer
  const { rate, virgaDepth, freezingLevel, hail } = { ...dry, ...layer.precipitation }
  const begun = (base - altitude) / (fallForm.onset * (top - base)) + 1
  const all =
    rateOf(rate, rank, Math.max(base - altitude, 0), virgaDepth) * Math.min(Math.max(begun, 0), 1)
  const stones = all * hail * MathUtils.smoothstep(rank, ...fallForm.hailFrom)
  return { rate: all - stones, hail: stones, snow: snowShareOf(altitude, freezingLevel) }
}

/**
 * Way by which what falls lags behind its cloud [m]: the path of a drop, step by step, through wind that grows evenly from a part of the
 * base's at the ground. `fallLag` of tsl/fall.ts has it in closed form.
 *
 * @param wind - Speed of the wind at the base [m/s].
 * @param rainSpeed - Speed of fall below the freezing level [m/s].
 */
export function lagOf(
  wind: number,
  altitude: number,
  base: number,
  freezingLevel: number,
  rainSpeed: number = fallForm.rainSpeed
): number {
  const { groundWind, snowSpeed } = fallForm
  const step = (base - altitude) / STEPS
  let lag = 0
  for (let i = 0; i < STEPS; i++) {
    const z = base - (i + 0.5) * step
    const speed = z > freezingLevel ? snowSpeed : rainSpeed
    const here = wind * (groundWind + ((1 - groundWind) * z) / base)
    lag += ((wind - here) * step) / speed
  }
  return lag
}

/** Rate at the base by the rank of a column [mm/h], and below, where some has evaporated: the differential equation, step by step. */
export function rateOf(rate: number, rank: number, depth: number, virgaDepth: number): number {
  const { core, evaporation: b } = fallForm
  let falling = rate * (core + 1) * rank ** core
  if (virgaDepth === 0) return falling
  // d(R^b)/dz is even, so that dR/dz = −R^(1−b) rate^b / (b depth).
  const step = depth / STEPS
  for (let i = 0; i < STEPS && falling > 0; i++) {
    const slope = (r: number): number => (Math.max(r, 0) ** (1 - b) * rate ** b) / (b * virgaDepth)
    const middle = falling - (slope(falling) * step) / 2
    falling -= slope(middle) * step
  }
  return Math.max(falling, 0)
}

/**
 * Rate of a streak over that of its column: the normal distribution of logarithms, cut off, with mean 1.
 *
 * @param deviations - Noise that blur has left, over its deviation.
 */
export function streakOf(deviations: number, amount: number, lost: number): number {
  const { coarseStreaks, fineStreaks } = fallForm
  const deviation = Math.hypot(coarseStreaks, fineStreaks) * amount * (1 - lost)
  const { from, factor } = streakBound
  const least = Math.min(deviation, from)
  const above = deviation - least
  // (least + above)² / 2, of which a part is made up for.
  const lowered = least ** 2 / 2 + least * above + (0.5 - factor) * above ** 2
  return Math.min(Math.exp(deviation * deviations - lowered), STRONGEST)
}

/**
 * Rank of the column from which it falls at a place, by planet-centred coordinates: `fallenFrom` of tsl/fall.ts, without streaks.
 *
 * @param position - Displacement from the planet's centre, in the mapped space [m].
 * @param isHail - True for stones, which fall faster.
 */
export function fallenRank(
  state: CloudState,
  noise: NoiseTextures,
  index: number,
  position: Vector3,
  distance: number,
  isHail = false
): number {
  const layer = state.layers[index]
  const { share, freezingLevel } = { ...dry, ...layer.precipitation }
  const wind = Math.hypot(layer.wind.east, layer.wind.north)
  const up = position.clone().normalize()
  const altitude = Math.min(position.length() - state.bottomRadius, layer.baseAltitude)
  const base = layer.baseAltitude
  const lag =
    (isHail
      ? lagOf(wind, altitude, base, Infinity, fallForm.hailSpeed)
      : lagOf(wind, altitude, base, freezingLevel)) +
    layer.shear * (base - altitude)
  const axis = windAxis(layer.wind, state.zenith ?? up, new Vector3())
  const source = position.clone().addScaledVector(axis.cross(up), lag)
  const { sum, coverage, storm } = weatherAt(state, noise, index, source, distance)
  let stronger = strongerShare(1.702 * sum) / strongerShare(Math.log(1 / coverage - 1))
  if (storm !== undefined) {
    const { topAltitude, baseAltitude } = layer
    const nearer = (d: number): number =>
      1 - Math.exp(-((d / stormCell(layer) / stormPlaces.scale) ** stormPlaces.power))
    const grown = storm.radius / (topAltitude - baseAltitude) / columnForm.grown
    const ofStorm = (nearer(storm.towerDistance) / nearer(storm.radius)) ** columnForm.near
    stronger = ofStorm / MathUtils.smoothstep(grown, 0, 1)
  }
  return Math.max(1 - stronger / share, 0)
}

/** Share of columns whose weather is stronger than one of some odds, ln((1 − q) / q) for the share q of a normal distribution [–]. */
const strongerShare = (odds: number): number =>
  1 / (1 + Math.exp(odds) * Math.exp(columnForm.tail * odds ** 3))
