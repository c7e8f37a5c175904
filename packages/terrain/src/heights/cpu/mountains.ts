import { fractalSum, type Octaves, type Sum } from '../../noise/cpu/fractalSum'
import { latticeNoise, type Noise } from '../../noise/cpu/latticeNoise'

/** Continents: from 8,400 km to 131 km. */
export const CONTINENTS: Octaves = { count: 7, inverse: 2 ** -23, gain: 0.55, seed: 11 }

/** Mountain ranges: from 1,050 km to 262 km. */
export const RANGES: Octaves = { count: 3, inverse: 2 ** -20, gain: 0.5, seed: 41 }

/** Ridges: from 33 km to 2 m. */
export const RIDGES: Octaves = { count: 15, inverse: 2 ** -15, gain: 0.47, seed: 71 }

/** Roundness of ridges' crests, in units of the noise. */
export const ROUNDNESS = 0.05

/** Scale of the noise under ridges: crests are where it is 0. */
export const STEEPNESS = 1.5

/** Mean of an octave of ridges. */
export const MEAN_RIDGE = 0.45

/** Roughness of an octave per height of the one before: ridges are rough, valleys smooth. */
export const ROUGHENING = 1.9

/** Height of land per unit of the continents [m], and at their 0. */
export const LAND_HEIGHT = 2400
export const LAND_OFFSET = -250

/** Ranges rise where the sum of continents and ranges is between these. */
export const RANGE_START = -0.15
export const RANGE_END = 0.75

/** Share of the mountains' height that plains have. */
export const PLAINS = 0.07

const noise: Noise = { x: 0, y: 0, z: 0, value: 0 }

/**
 * Ridged multifractal, at full detail: crests where noise is 0, each octave as rough as those before are high.
 * Twin of the shader's.
 */
export function ridgedSum(
  x: number,
  y: number,
  z: number,
  { count, inverse, gain, seed: first }: Octaves,
  seed: number,
  target: Sum
): Sum {
  target.x = target.y = target.z = target.value = 0
  let weight = 1
  const turn = { x: 0, y: 0, z: 0 }
  for (let i = 0; i < count; i++) {
    const scale = inverse * 2 ** i
    const amplitude = gain ** i
    latticeNoise(x, y, z, scale, first + seed + i, noise)
    const value = STEEPNESS * noise.value
    const root = Math.hypot(value, ROUNDNESS)
    const ridge = (1 - root) ** 2
    const steepness = (-2 * (1 - root) * value * STEEPNESS * scale) / root
    const sx = steepness * noise.x
    const sy = steepness * noise.y
    const sz = steepness * noise.z
    target.value += amplitude * weight * (ridge - MEAN_RIDGE)
    target.x += amplitude * (weight * sx + (ridge - MEAN_RIDGE) * turn.x)
    target.y += amplitude * (weight * sy + (ridge - MEAN_RIDGE) * turn.y)
    target.z += amplitude * (weight * sz + (ridge - MEAN_RIDGE) * turn.z)
    const next = Math.min(ROUGHENING * ridge * weight, 1)
    const slope = 2 * (1 - next) * ROUGHENING
    turn.x = slope * (sx * weight + ridge * turn.x)
    turn.y = slope * (sy * weight + ridge * turn.y)
    turn.z = slope * (sz * weight + ridge * turn.z)
    weight = next * (2 - next)
  }
  return target
}

const land: Sum = { x: 0, y: 0, z: 0, value: 0 }
const range: Sum = { x: 0, y: 0, z: 0, value: 0 }
const ridges: Sum = { x: 0, y: 0, z: 0, value: 0 }

/**
 * Height of continents, ranges and ridges, with its gradient [–]. Twin of the shader's.
 *
 * @param relief - Height of the highest ridges over the land [m].
 * @param seed - Added to all seeds.
 * @returns Height as `value` [m].
 */
export function mountains(
  x: number,
  y: number,
  z: number,
  relief: number,
  seed: number,
  target: Sum
): Sum {
  fractalSum(x, y, z, CONTINENTS, seed, land)
  fractalSum(x, y, z, RANGES, seed, range)
  ridgedSum(x, y, z, RIDGES, seed, ridges)
  const width = RANGE_END - RANGE_START
  const t = Math.min(Math.max((land.value + range.value - RANGE_START) / width, 0), 1)
  const mask = PLAINS + (1 - PLAINS) * t * t * (3 - 2 * t)
  const edge = ((1 - PLAINS) * 6 * t * (1 - t)) / width
  target.value = LAND_OFFSET + LAND_HEIGHT * land.value + relief * mask * ridges.value
  for (const axis of ['x', 'y', 'z'] as const) {
    const turn = edge * (land[axis] + range[axis])
    target[axis] = LAND_HEIGHT * land[axis] + relief * (mask * ridges[axis] + turn * ridges.value)
  }
  return target
}
