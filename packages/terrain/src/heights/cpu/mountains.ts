import { fractalSum, type Octaves, type Sum } from '../../noise/cpu/fractalSum'
import { latticeNoise, type Noise } from '../../noise/cpu/latticeNoise'

/** Domain warp: noise displaces places, so that crests and coasts do not follow the lattice of the noise. */
export interface Warp {
  /** 1 / wavelength, a power of two [1/m]. */
  readonly inverse: number
  /** Displacement along an axis per unit of noise [m]. */
  readonly reach: number
  /** Seed of the first axis; each next one has the next. */
  readonly seed: number
}

/** Domain warp of continents and belts. */
export const LAND_WARP: Warp = { inverse: 2 ** -20, reach: 3e5, seed: 301 }

/** Domain warp of ridges. */
export const RIDGE_WARP: Warp = { inverse: 2 ** -15, reach: 1.1e4, seed: 331 }

/** Continents: from 8,400 km to 524 km. */
export const CONTINENTS: Octaves = { count: 5, inverse: 2 ** -23, gain: 0.55, seed: 11 }

/** A family of mountain belts: long, curved, along places where noise is 0, and strong in places. */
export interface Belts {
  /** 1 / wavelength of the noise, a power of two [1/m]. */
  readonly inverse: number
  readonly seed: number
  /** Half width, in units of the noise. */
  readonly width: number
  /** Strength of the strongest. */
  readonly strength: number
  /** Displacement along this axis of `LAND_WARP`, per reach, over which belts rise from nothing to their full strength. */
  readonly axis: 0 | 1
  readonly start: number
  readonly end: number
}

/** Chains across continents, and shorter ones. */
export const CHAINS: Belts = {
  inverse: 2 ** -22,
  seed: 41,
  width: 0.06,
  strength: 1,
  axis: 0,
  start: -0.3,
  end: 0.3
}
export const SHORT_CHAINS: Belts = {
  inverse: 2 ** -21,
  seed: 43,
  width: 0.05,
  strength: 0.6,
  axis: 1,
  start: -0.1,
  end: 0.4
}

/**
 * Ridges: from 66 km to 4 m. The first octaves are valleys, where noise is 0, between massifs; the others are crests there.
 * Those of 1 km and more are displaced: of shorter ones float32 would lose the phase.
 */
export const RIDGES = { count: 15, inverse: 2 ** -16, seed: 71, valleys: 2, moved: 7 }

/**
 * Amplitude of an octave is 1 / Σ a b^n over these: most at 16 to 33 km, and from 250 m on less and less, as where soil creeps and fills
 * hollows. Less of the last: meadows are hummocks of 4 m to 30 m (*Terrain*, Meadow).
 */
export const LONG = [3, 0.39] as const
export const SHORT = [0.305, 1 / 0.47] as const
export const SOFT = [0.006, 1 / 0.3] as const

/** Roundness of crests and of valleys' floors, in units of the noise. */
export const ROUNDNESS = 0.05

/** Scale of the noise under ridges: crests are where it is 0. */
export const STEEPNESS = 1.5

/** Mean of an octave of crests; of one of valleys, what that lacks of 1. */
export const MEAN_RIDGE = 0.45

/** Roughness of an octave per height of the one before: ridges are rough, valleys smooth. From octave `CRAGS` on only crests are. */
export const ROUGHENING = 1.9
export const CRAGS = 8
export const CRAG_ROUGHENING = 1.2

/** Height of land per unit of the continents [m], and at their 0. */
export const LAND_HEIGHT = 2400
export const LAND_OFFSET = -250

/** Height that belts lift the ground by, per relief. */
export const UPLIFT = 0.5

/** Shares of the relief: everywhere, in hills of high land, and in belts. */
export const PLAINS = 0.03
export const HILLS = 0.1
export const BELT_RIDGES = 0.95

/** Part of the ridges of belts that grows as their height does, and not by its square. 1: coasts at their feet are broken into islands. */
export const FOOTHILLS = 0.35

/**
 * Heights of the land without ridges between which they rise to their full height [m], and their share below. Without: coasts in belts are shreds
 * of islands (*Terrain*, Orbit).
 */
export const COASTAL = [0, 900] as const
export const COASTAL_RIDGES = 0.1

/** Sum of continents over which hills rise. */
export const HILLS_START = 0
export const HILLS_END = 0.4

const noise: Noise = { x: 0, y: 0, z: 0, value: 0 }

/** Amplitude of an octave of ridges [–]. */
export const ridgeAmplitude = (octave: number): number =>
  1 / [LONG, SHORT, SOFT].reduce((sum, [first, ratio]) => sum + first * ratio ** octave, 0)

/** Smooth step from 0 to 1, and its slope. */
function smooth(start: number, end: number, value: number): [number, number] {
  const t = Math.min(Math.max((value - start) / (end - start), 0), 1)
  return [t * t * (3 - 2 * t), (6 * t * (1 - t)) / (end - start)]
}

/** Place and displacement, each with its gradient [1/m]. */
class Warped {
  x = 0
  y = 0
  z = 0
  /** Displacement along each axis, per reach. */
  readonly moves: readonly Sum[] = [0, 1, 2].map(() => ({ x: 0, y: 0, z: 0, value: 0 }))

  move(x: number, y: number, z: number, { inverse, reach, seed }: Warp, shift: number): this {
    for (const [axis, move] of this.moves.entries()) {
      latticeNoise(x, y, z, inverse, seed + shift + axis, move)
      move.x *= inverse
      move.y *= inverse
      move.z *= inverse
    }
    this.x = x + reach * this.moves[0].value
    this.y = y + reach * this.moves[1].value
    this.z = z + reach * this.moves[2].value
    return this
  }

  /** Turns a gradient at the displaced place into that at the place itself. */
  back(sum: Sum, { reach }: Warp): void {
    const { x, y, z } = sum
    const [a, b, c] = this.moves
    for (const axis of ['x', 'y', 'z'] as const) {
      sum[axis] += reach * (a[axis] * x + b[axis] * y + c[axis] * z)
    }
  }
}

const landWarp = new Warped()
const ridgeWarp = new Warped()

/** Ridged multifractal of valleys and crests, at full detail: each octave is as rough as those before are high. Twin of the shader's. */
function ridgedSum(x: number, y: number, z: number, seed: number, target: Sum): Sum {
  const { count, inverse, seed: first, valleys, moved } = RIDGES
  ridgeWarp.move(x, y, z, RIDGE_WARP, seed)
  target.x = target.y = target.z = target.value = 0
  let weight = 1
  const turn = { x: 0, y: 0, z: 0 }
  for (let i = 0; i < count; i++) {
    const scale = inverse * 2 ** i
    const amplitude = ridgeAmplitude(i)
    if (i < moved) {
      latticeNoise(ridgeWarp.x, ridgeWarp.y, ridgeWarp.z, scale, first + seed + i, noise)
      ridgeWarp.back(noise, RIDGE_WARP)
    } else latticeNoise(x, y, z, scale, first + seed + i, noise)
    const value = STEEPNESS * noise.value
    const root = Math.hypot(value, ROUNDNESS)
    const isValley = i < valleys
    const sign = isValley ? -1 : 1
    const ridge = (isValley ? 1 : 0) + sign * (1 - root) ** 2
    const over = ridge - (isValley ? 1 - MEAN_RIDGE : MEAN_RIDGE)
    const steepness = (sign * -2 * (1 - root) * value * STEEPNESS * scale) / root
    const sx = steepness * noise.x
    const sy = steepness * noise.y
    const sz = steepness * noise.z
    target.value += amplitude * weight * over
    target.x += amplitude * (weight * sx + over * turn.x)
    target.y += amplitude * (weight * sy + over * turn.y)
    target.z += amplitude * (weight * sz + over * turn.z)
    const roughening = i < CRAGS ? ROUGHENING : CRAG_ROUGHENING
    const next = Math.min(roughening * ridge * weight, 1)
    const slope = 2 * (1 - next) * roughening
    turn.x = slope * (sx * weight + ridge * turn.x)
    turn.y = slope * (sy * weight + ridge * turn.y)
    turn.z = slope * (sz * weight + ridge * turn.z)
    weight = next * (2 - next)
  }
  return target
}

/** Strength of a family of belts at a place that `landWarp` has. */
function beltsAt(belts: Belts, seed: number, target: Sum): Sum {
  const { inverse, width, strength, axis, start, end } = belts
  const { x, y, z, moves } = landWarp
  latticeNoise(x, y, z, inverse, belts.seed + seed, target)
  const ratio = target.value / width
  const fall = 1 / (1 + ratio * ratio)
  const [there, edge] = smooth(start, end, moves[axis].value)
  const turn = (-4 * ratio * fall ** 3 * there * strength * inverse) / width
  target.x *= turn
  target.y *= turn
  target.z *= turn
  landWarp.back(target, LAND_WARP)
  for (const along of ['x', 'y', 'z'] as const) {
    target[along] += fall * fall * edge * strength * moves[axis][along]
  }
  target.value = fall * fall * there * strength
  return target
}

const land: Sum = { x: 0, y: 0, z: 0, value: 0 }
const belt: Sum = { x: 0, y: 0, z: 0, value: 0 }
const short: Sum = { x: 0, y: 0, z: 0, value: 0 }
const ridges: Sum = { x: 0, y: 0, z: 0, value: 0 }

/**
 * Height of continents, belts and ridges, with its gradient [–]. Twin of the shader's.
 *
 * @param relief - Height of the highest ridges over the valleys [m].
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
  landWarp.move(x, y, z, LAND_WARP, seed)
  fractalSum(landWarp.x, landWarp.y, landWarp.z, CONTINENTS, seed, land)
  landWarp.back(land, LAND_WARP)
  beltsAt(CHAINS, seed, belt)
  beltsAt(SHORT_CHAINS, seed, short)
  ridgedSum(x, y, z, seed, ridges)
  const lift = 1 - (1 - belt.value) * (1 - short.value)
  const [hills, edge] = smooth(HILLS_START, HILLS_END, land.value)
  const rugged = lift * (FOOTHILLS + (1 - FOOTHILLS) * lift)
  const ruggedPerLift = FOOTHILLS + 2 * (1 - FOOTHILLS) * lift
  const mask = PLAINS + HILLS * hills + BELT_RIDGES * rugged
  const level = LAND_OFFSET + LAND_HEIGHT * land.value + relief * UPLIFT * lift
  const [inner, start] = smooth(...COASTAL, level)
  const share = COASTAL_RIDGES + (1 - COASTAL_RIDGES) * inner
  const sharePerLevel = (1 - COASTAL_RIDGES) * start
  const mountain = relief * mask * ridges.value
  target.value = level + share * mountain
  for (const axis of ['x', 'y', 'z'] as const) {
    const rise = belt[axis] * (1 - short.value) + short[axis] * (1 - belt.value)
    const turn = HILLS * edge * land[axis] + BELT_RIDGES * ruggedPerLift * rise
    const slope = LAND_HEIGHT * land[axis] + relief * UPLIFT * rise
    target[axis] =
      slope * (1 + sharePerLevel * mountain) +
      share * relief * (mask * ridges[axis] + turn * ridges.value)
  }
  return target
}
