import type { Vector3 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import type { Float, Vec4 } from '../tsl-types'
import {
  CONTINENTS,
  LAND_HEIGHT,
  LAND_OFFSET,
  MEAN_RIDGE,
  mountains,
  RANGE_END,
  RANGE_START,
  RANGES,
  RIDGES
} from './cpu/mountains'
import type { Octaves } from '../noise/cpu/fractalSum'
import type { HeightSample, HeightSource, SurfacePoint } from './HeightSource'
import { mountains as mountainNodes } from './tsl/mountains'

/** Options of {@link MountainHeights}. */
export interface MountainHeightsOptions {
  /** Height of ridges over the land about them, in (0, 20,000], default 4,200 [m]. */
  relief?: number
  /** Whole number in [0, 1e6], default 0: another one, another planet. */
  seed?: number
}

const sum = { x: 0, y: 0, z: 0, value: 0 }

/** Bounds of an octave of noise, and of its slope per wavelength: 0.76 and 2.5 in 3e5 random places. */
const NOISE_BOUND = 0.9
const NOISE_SLOPE = 3

/** Bound of the slope of an octave of ridges, per wavelength. */
const RIDGE_SLOPE = 12

/** Bounds of all slopes: of land, and of ridges per metre of relief; in 1e4 places up to 1.3 at a relief of 4,200 m. */
const LAND_SLOPE = 0.2
const STEEPEST = 1.8 / 4200

/** Sum over octaves, each at most `slope` wavelengths or `most`, in units of the first one's amplitude. */
const most = (octaves: Octaves, slope: number, limit: number): number => {
  let total = 0
  let amplitude = 1
  let steepness = slope * octaves.inverse
  for (let i = 0; i < octaves.count; i++) {
    total += amplitude * Math.min(steepness, limit)
    amplitude *= octaves.gain
    steepness *= 2
  }
  return total
}

/**
 * Heights of a made-up planet, from a function: continents, mountain ranges, ridges and valleys down to 2 m. Not a byte
 * is loaded, and the CPU knows every height.
 *
 * ```ts
 * const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 3 }))
 * ```
 */
export class MountainHeights implements HeightSource {
  /** Height of ridges over the land about them [m]. */
  readonly relief: number
  /** Whole number: another one, another planet. */
  readonly seed: number
  readonly lowest: number
  readonly highest: number
  readonly #reliefNode: Float
  readonly #seedNode: Float

  /** @throws If an option is unknown or out of its range. */
  constructor(options: MountainHeightsOptions = {}) {
    checkOptions('MountainHeights', options, 'relief', 'seed')
    const { relief = 4200, seed = 0 } = options
    checkPositive('MountainHeights', 'relief', relief)
    if (relief > 20_000) fail('MountainHeights', 'relief must be at most 20000', relief)
    if (!Number.isInteger(seed) || seed < 0 || seed > 1e6) {
      fail('MountainHeights', 'seed must be a whole number in [0, 1e6]', seed)
    }
    this.relief = relief
    this.seed = seed
    const land = LAND_HEIGHT * most(CONTINENTS, Infinity, NOISE_BOUND)
    this.lowest = LAND_OFFSET - land - relief * most(RIDGES, Infinity, MEAN_RIDGE)
    this.highest = LAND_OFFSET + land + relief * most(RIDGES, Infinity, 1 - MEAN_RIDGE)
    this.#reliefNode = uniform(relief).setGroup(renderGroup)
    this.#seedNode = uniform(seed).setGroup(renderGroup)
  }

  variation(distance: number): number {
    const land = most(CONTINENTS, NOISE_SLOPE * distance, 2 * NOISE_BOUND)
    const range = most(RANGES, NOISE_SLOPE * distance, 2 * NOISE_BOUND)
    const mask = Math.min((1.5 * (land + range)) / (RANGE_END - RANGE_START), 1)
    const ridges = most(RIDGES, RIDGE_SLOPE * distance, 1)
    return Math.min(
      LAND_HEIGHT * land + this.relief * (ridges + mask * most(RIDGES, Infinity, 1)),
      (LAND_SLOPE + STEEPEST * this.relief) * distance
    )
  }

  sampleAt({ x, y, z }: Vector3, target: HeightSample): HeightSample {
    mountains(x, y, z, this.relief, this.seed, sum)
    target.height = sum.value
    target.gradient.set(sum.x, sum.y, sum.z)
    return target
  }

  sample({ reference, offset }: SurfacePoint, shortest: Float): Vec4 {
    return mountainNodes(reference, offset, shortest, this.#reliefNode, this.#seedNode)
  }
}
