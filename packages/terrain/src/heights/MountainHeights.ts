import type { Vector3 } from 'three'
import { renderGroup, uniform } from 'three/tsl'
import { checkOptions, checkPositive, fail } from '@welkin/geo'
import type { Float, Vec4 } from '../tsl-types'
import {
  BELT_RIDGES,
  CHAINS,
  CONTINENTS,
  HILLS,
  HILLS_END,
  HILLS_START,
  LAND_HEIGHT,
  LAND_OFFSET,
  LAND_WARP,
  MEAN_RIDGE,
  mountains,
  PLAINS,
  ridgeAmplitude,
  RIDGES,
  RIDGE_WARP,
  SHORT_CHAINS,
  UPLIFT,
  type Belts,
  type Warp
} from './cpu/mountains'
import type { HeightSample, HeightSource, SurfacePoint } from './HeightSource'
import { mountains as mountainNodes } from './tsl/mountains'

/** Options of {@link MountainHeights}. */
export interface MountainHeightsOptions {
  /** Height of ridges over the valleys about them, in (0, 20,000], default 4,200 [m]. */
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

/** Bounds of all slopes: of land, and of ridges per metre of relief; in 1.5e5 places up to 1.93 at a relief of 4,200 m. */
const LAND_SLOPE = 0.2
const STEEPEST = 2.4 / 4200

/** Largest change of an octave at a distance of so many wavelengths. */
const change = (wavelengths: number): number => Math.min(NOISE_SLOPE * wavelengths, 2 * NOISE_BOUND)

/** Factor at most on distances between places that are moved. */
const stretch = ({ inverse, reach }: Warp): number =>
  1 + Math.sqrt(3) * NOISE_SLOPE * inverse * reach

/** Sum over the octaves of continents of each one's change. */
const landChange = (distance: number): number => {
  const { count, inverse, gain } = CONTINENTS
  let total = 0
  for (let i = 0; i < count; i++) total += gain ** i * change(distance * inverse * 2 ** i)
  return total
}

/** Sum over the octaves of ridges: each changes by at most `RIDGE_SLOPE` per wavelength, or 1. */
const ridgeChange = (distance: number): number => {
  let total = 0
  for (let i = 0; i < RIDGES.count; i++) {
    total += ridgeAmplitude(i) * Math.min(RIDGE_SLOPE * RIDGES.inverse * 2 ** i * distance, 1)
  }
  return total
}

/** Largest change of a family of belts. The steepest slope of 1 / (1 + x²)² is 1.04. */
const beltChange = ({ inverse, width, strength, start, end }: Belts, distance: number): number => {
  const across = (1.04 / width) * change(inverse * stretch(LAND_WARP) * distance)
  const along = (1.5 / (end - start)) * change(LAND_WARP.inverse * distance)
  return strength * Math.min(across + along, 1)
}

/**
 * Heights of a made-up planet, from a function: continents, belts of mountains, hills and plains, ridges and valleys down to 4 m. Not a byte
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
    const land = (LAND_HEIGHT * landChange(Infinity)) / 2
    const ridges = (PLAINS + HILLS + BELT_RIDGES) * (1 - MEAN_RIDGE) * ridgeChange(Infinity)
    this.lowest = LAND_OFFSET - land - relief * ridges
    this.highest = LAND_OFFSET + land + relief * (ridges + UPLIFT)
    this.#reliefNode = uniform(relief).setGroup(renderGroup)
    this.#seedNode = uniform(seed).setGroup(renderGroup)
  }

  variation(distance: number): number {
    const land = landChange(stretch(LAND_WARP) * distance)
    const lift = Math.min(beltChange(CHAINS, distance) + beltChange(SHORT_CHAINS, distance), 1)
    const hills = Math.min((1.5 * land) / (HILLS_END - HILLS_START), 1)
    const mask = (HILLS * hills + BELT_RIDGES * lift) * (1 - MEAN_RIDGE) * ridgeChange(Infinity)
    const ridges = (PLAINS + HILLS + BELT_RIDGES) * ridgeChange(stretch(RIDGE_WARP) * distance)
    return Math.min(
      LAND_HEIGHT * land + this.relief * (UPLIFT * lift + mask + ridges),
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
