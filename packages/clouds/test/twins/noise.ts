import { Vector3 } from 'three'
import {
  CURL_CELLS,
  CURL_SCALE,
  noiseStatistics,
  seedOf,
  type NoiseChannel
} from '../../src/noise/noiseRecipes'

/** Three numbers: coordinates, or channels of a texture. */
export type Vec3Array = readonly [number, number, number]

const increment = 1013904223
const multiplier = 1664525

/**
 * Float64 twin of `hashCell`: three numbers in [0, 1) for a cell of a lattice, the same bits as the
 * shader's.
 *
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", PCG3D.
 */
export function hashCell(i: number, j: number, k: number, target = new Vector3()): Vector3 {
  let x = (Math.imul(i, multiplier) + increment) | 0
  let y = (Math.imul(j, multiplier) + increment) | 0
  let z = (Math.imul(k, multiplier) + increment) | 0
  x = (x + Math.imul(y, z)) | 0
  y = (y + Math.imul(z, x)) | 0
  z = (z + Math.imul(x, y)) | 0
  x ^= x >>> 16
  y ^= y >>> 16
  z ^= z >>> 16
  x = (x + Math.imul(y, z)) | 0
  y = (y + Math.imul(z, x)) | 0
  z = (z + Math.imul(x, y)) | 0
  return target.set((x >>> 8) / 2 ** 24, (y >>> 8) / 2 ** 24, (z >>> 8) / 2 ** 24)
}

const wrap = (i: number, cells: number): number => ((i % cells) + cells) % cells
const _hash = new Vector3()

/** Float64 twin of `perlin`: gradient noise of period 1 in each coordinate, about [−1, 1]. */
export function perlin(p: Vec3Array, cells: Vec3Array, seed: number): number {
  const base = p.map((x, axis) => Math.floor(x * cells[axis]))
  const part = p.map((x, axis) => x * cells[axis] - base[axis])
  const fade = part.map(t => t ** 3 * (10 + t * (6 * t - 15)))
  let sum = 0
  for (let corner = 0; corner < 8; corner++) {
    const offset = [corner & 1, (corner >> 1) & 1, corner >> 2]
    const [i, j, k] = offset.map((o, axis) => wrap(base[axis] + o, cells[axis]))
    const gradient = hashCell(i, j, k + seed, _hash).toArray()
    let height = 0
    let weight = 1
    for (let axis = 0; axis < 3; axis++) {
      height += (2 * gradient[axis] - 1) * (part[axis] - offset[axis])
      weight *= offset[axis] === 1 ? fade[axis] : 1 - fade[axis]
    }
    sum += weight * height
  }
  return 1.5 * sum
}

/**
 * Float64 twin of `billow`: 1 − F₁², with F₁ the distance to the nearest of the points scattered one
 * in each cell: round heads that meet in sharp creases. Period 1, in [0, 1].
 */
export function billow(p: Vec3Array, cells: Vec3Array, seed: number): number {
  const base = p.map((x, axis) => Math.floor(x * cells[axis]))
  let nearest = 1
  for (let n = 0; n < 27; n++) {
    const cell = [n % 3, Math.floor(n / 3) % 3, Math.floor(n / 9)].map((o, a) => base[a] + o - 1)
    const [i, j, k] = cell.map((c, axis) => wrap(c, cells[axis]))
    const point = hashCell(i, j, k + seed, _hash).toArray()
    let square = 0
    for (let axis = 0; axis < 3; axis++) {
      square += (cell[axis] + point[axis] - p[axis] * cells[axis]) ** 2
    }
    nearest = Math.min(nearest, square)
  }
  return 1 - nearest
}

const terms = { perlin, billow }

/** Φ(z) of the normal distribution to 0.01, as the shader has it. */
const cumulative = (z: number): number => 1 / (1 + Math.exp(-1.702 * z))

/** Float64 twin of `channelNoise`. */
export function channelNoise(channel: NoiseChannel, index: number, p: Vec3Array): number {
  const place = [...p] as [number, number, number]
  if (channel.warp !== undefined) {
    const { cells, amount } = channel.warp
    for (let axis = 0; axis < 3; axis++) {
      place[axis] +=
        amount * perlin(p, [cells, cells, cells], seedOf(index, channel.terms.length + axis))
    }
  }
  let sum = 0
  let variance = 0
  channel.terms.forEach(({ kind, cells, weight }, i) => {
    const [mean, deviation] = noiseStatistics[kind]
    sum += weight * (terms[kind](place, cells, seedOf(index, i)) - mean)
    variance += (weight * deviation) ** 2
  })
  const z = sum / Math.sqrt(variance)
  if (channel.encoding === 'normal') return Math.min(Math.max(0.5 + 0.18 * z, 0), 1)
  return cumulative(z)
}

const potential = (p: Vec3Array, axis: number): number =>
  perlin(p, [CURL_CELLS, CURL_CELLS, CURL_CELLS], 3001 + 17 * axis)

/** Float64 twin of `curlNoise`: a field without divergence, encoded in [0, 1]. */
export function curlNoise(p: Vec3Array): Vec3Array {
  const step = 0.02 / CURL_CELLS
  const slope = (component: number, axis: number): number => {
    const moved = (sign: number): Vec3Array =>
      p.map((x, i) => x + (i === axis ? sign * step : 0)) as unknown as Vec3Array
    return (potential(moved(1), component) - potential(moved(-1), component)) / 0.04
  }
  return [0, 1, 2].map(axis => {
    const [next, last] = [(axis + 1) % 3, (axis + 2) % 3]
    const curl = slope(last, next) - slope(next, last)
    return Math.min(Math.max(0.5 + CURL_SCALE * curl, 0), 1)
  }) as unknown as Vec3Array
}
