import type { Vector3 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import type { Float, Vec4 } from '../tsl-types'
import {
  BELT_RIDGES,
  CONTINENTS,
  HILLS,
  LAND_HEIGHT,
  LAND_OFFSET,
  MEAN_RIDGE,
  mountains,
  PLAINS,
  ridgeAmplitude,
  RIDGES,
  UPLIFT
} from './cpu/mountains'
import type { HeightSample, HeightSource, SurfacePoint } from './HeightSource'
import { mountains as mountainNodes } from './tsl/mountains'

/** Options of {@link MountainHeights}. */
export interface MountainHeightsOptions {
  /** Height of ridges over the valleys about them, in (0, 20,000], default 4,200 [m]. */
  relief?: number
  /** Seed of the planet, a whole number in [0, 1e6], default 0. */
  seed?: number
}

const sum = { x: 0, y: 0, z: 0, value: 0 }

/** Bound of an octave of noise: 0.76 in 3e5 random places. */
const NOISE_BOUND = 0.9

/** Bounds of all slopes: of land, and of ridges per metre of relief; in 1.5e5 places up to 1.93 at a relief of 4,200 m. */
const LAND_SLOPE = 0.2
const STEEPEST = 2.4 / 4200

/** Sum of the amplitudes of octaves. */
const total = (count: number, amplitude: (octave: number) => number): number =>
  Array.from({ length: count }, (_, octave) => amplitude(octave)).reduce((a, b) => a + b)

/**
 * Heights of a procedural planet: continents, belts of mountains, hills and plains, ridges and valleys down to 4 m. No data is loaded, and
 * the CPU knows every height.
 *
 * ```ts
 * const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 3 }))
 * ```
 */
export class MountainHeights implements HeightSource {
  /** Height of ridges over the land about them [m]. */
  readonly relief: number
  /** Seed of the planet. */
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
    const { count, gain } = CONTINENTS
    const land = LAND_HEIGHT * NOISE_BOUND * total(count, octave => gain ** octave)
    const mask = (PLAINS + HILLS + BELT_RIDGES) * (1 - MEAN_RIDGE)
    const ridges = relief * mask * total(RIDGES.count, ridgeAmplitude)
    this.lowest = LAND_OFFSET - land - ridges
    this.highest = LAND_OFFSET + land + ridges + relief * UPLIFT
    this.#reliefNode = uniform(relief).setGroup(renderGroup)
    this.#seedNode = uniform(seed).setGroup(renderGroup)
  }

  variation(distance: number): number {
    return Math.min((LAND_SLOPE + STEEPEST * this.relief) * distance, this.highest - this.lowest)
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
