import { Vector3 } from 'three'
import {
  ENCODING_SCALE,
  noiseDeviations,
  seedOf,
  shapeCurl,
  type NoiseChannel
} from '../../src/noise/noiseRecipes'

/** Three numbers: coordinates, or channels of a texture. */
export type Vec3Array = readonly [number, number, number]

const increment = 1013904223
const multiplier = 1664525
const _bits = new Int32Array(3)

/**
 * Float64 twin of `hashBits`: 96 bits for a cell of a lattice, the same as the shader's.
 *
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", JCGT 9 (3), supplement: pcg3d.
 */
export function hashBits(i: number, j: number, k: number): Int32Array {
  let x = (Math.imul(i, multiplier) + increment) | 0
  let y = (Math.imul(j, multiplier) + increment) | 0
  let z = (Math.imul(k, multiplier) + increment) | 0
  x = (x + Math.imul(y, z)) | 0
  y = (y + Math.imul(z, x)) | 0
  z = (z + Math.imul(x, y)) | 0
  x ^= x >>> 16
  y ^= y >>> 16
  z ^= z >>> 16
  _bits[0] = x + Math.imul(y, z)
  _bits[1] = y + Math.imul(z, _bits[0])
  _bits[2] = z + Math.imul(_bits[0], _bits[1])
  return _bits
}

/** Float64 twin of `hashCell`: three numbers in [0, 1) for a cell of a lattice. */
export function hashCell(i: number, j: number, k: number, target = new Vector3()): Vector3 {
  const bits = hashBits(i, j, k)
  return target.set((bits[0] >>> 9) / 2 ** 23, (bits[1] >>> 9) / 2 ** 23, (bits[2] >>> 9) / 2 ** 23)
}

const wrap = (i: number, cells: number): number => ((i % cells) + cells) % cells
const _hash = new Vector3()

/** Quintic fade curve, and its slope. */
const fadeOf = (t: number): number => t ** 3 * (10 + t * (6 * t - 15))
const slopeOf = (t: number): number => 30 * t ** 2 * (1 - t) ** 2

/** Float64 twin of `perlin`: gradient noise of period 1 in each coordinate, about [−1, 1]. */
export function perlin(p: Vec3Array, cells: Vec3Array, seed: number): number {
  const [x, y, z] = [p[0] * cells[0], p[1] * cells[1], p[2] * cells[2]]
  const [i, j, k] = [Math.floor(x), Math.floor(y), Math.floor(z)]
  const [u, v, w] = [x - i, y - j, z - k]
  const [fadeX, fadeY, fadeZ] = [fadeOf(u), fadeOf(v), fadeOf(w)]
  let sum = 0
  for (let corner = 0; corner < 8; corner++) {
    const [a, b, c] = [corner & 1, (corner >> 1) & 1, corner >> 2]
    const [cellX, cellY] = [wrap(i + a, cells[0]), wrap(j + b, cells[1])]
    const gradient = hashCell(cellX, cellY, wrap(k + c, cells[2]) + seed, _hash)
    const height =
      (2 * gradient.x - 1) * (u - a) +
      (2 * gradient.y - 1) * (v - b) +
      (2 * gradient.z - 1) * (w - c)
    const [weightX, weightY] = [a === 1 ? fadeX : 1 - fadeX, b === 1 ? fadeY : 1 - fadeY]
    sum += weightX * weightY * (c === 1 ? fadeZ : 1 - fadeZ) * height
  }
  return 1.5 * sum
}

/** Component `axis` of gradient `potential` of a corner of `stir`, in (−1, 1). */
const gradientPart = (bits: Int32Array, potential: number, axis: number): number =>
  (((bits[potential] >>> (22 - 10 * axis)) & 1023) + 0.5) / 512 - 1

/**
 * The three potentials whose curl is `stir`, and their slopes, per cell.
 *
 * @returns For each potential: the value, and its derivatives along x, y and z.
 */
export function potentials(p: Vec3Array, cells: number, seed: number): number[][] {
  const base = p.map(x => Math.floor(x * cells))
  const part = p.map((x, axis) => x * cells - base[axis])
  const fade = part.map(fadeOf)
  const slope = part.map(slopeOf)
  const sums = [0, 1, 2].map(() => [0, 0, 0, 0])
  for (let corner = 0; corner < 8; corner++) {
    const offset = [corner & 1, (corner >> 1) & 1, corner >> 2]
    const weights = offset.map((o, axis) => (o === 1 ? fade[axis] : 1 - fade[axis]))
    const slopes = offset.map((o, axis) => (o === 1 ? slope[axis] : -slope[axis]))
    const weight = weights[0] * weights[1] * weights[2]
    const [i, j, k] = offset.map((o, axis) => wrap(base[axis] + o, cells))
    const bits = hashBits(i, j, k + seed)
    for (let potential = 0; potential < 3; potential++) {
      let height = 0
      for (let axis = 0; axis < 3; axis++) {
        const gradient = gradientPart(bits, potential, axis)
        height += gradient * (part[axis] - offset[axis])
        sums[potential][1 + axis] += weight * gradient
      }
      sums[potential][0] += weight * height
      sums[potential][1] += slopes[0] * weights[1] * weights[2] * height
      sums[potential][2] += weights[0] * slopes[1] * weights[2] * height
      sums[potential][3] += weights[0] * weights[1] * slopes[2] * height
    }
  }
  return sums
}

/** Float64 twin of `curl`: of the potentials, from their derivatives. */
export function curl(p: Vec3Array, cells: number, seed: number): Vec3Array {
  const [a, b, c] = potentials(p, cells, seed)
  return [c[2] - b[3], a[3] - c[1], b[1] - a[2]]
}

/**
 * Float64 twin of `billow`: 1 − F₁, with F₁ the distance to the nearest of the points scattered one
 * in each cell: round bulges that meet in sharp creases. Period 1, in [0, 1].
 */
export function billow(p: Vec3Array, cells: Vec3Array, seed: number): number {
  const [x, y, z] = [p[0] * cells[0], p[1] * cells[1], p[2] * cells[2]]
  const [i, j, k] = [Math.floor(x), Math.floor(y), Math.floor(z)]
  let nearest = 1
  for (let c = k - 1; c <= k + 1; c++) {
    for (let b = j - 1; b <= j + 1; b++) {
      for (let a = i - 1; a <= i + 1; a++) {
        const cell = [wrap(a, cells[0]), wrap(b, cells[1]), wrap(c, cells[2])]
        const point = hashCell(cell[0], cell[1], cell[2] + seed, _hash)
        const [dx, dy, dz] = [a + point.x - x, b + point.y - y, c + point.z - z]
        nearest = Math.min(nearest, Math.sqrt(dx * dx + dy * dy + dz * dz))
      }
    }
  }
  return 1 - nearest
}

const terms = { perlin, billow }

/** Weighted sum of a channel's terms, before it is encoded. */
export function channelSum(channel: NoiseChannel, index: number, p: Vec3Array): number {
  const { terms: parts, warp } = channel
  const place = [...p] as [number, number, number]
  if (warp !== undefined) {
    const { cells, amount } = warp
    for (let axis = 0; axis < 3; axis++) {
      place[axis] += amount * perlin(p, [cells, cells, cells], seedOf(index, parts.length + axis))
    }
  }
  let sum = 0
  parts.forEach(({ kind, cells, weight, stir }, i) => {
    if (stir !== undefined) {
      const shift = curl(p, stir.cells, seedOf(index, parts.length + i))
      for (let axis = 0; axis < 3; axis++) {
        place[axis] += (stir.amount / noiseDeviations.curl) * shift[axis]
      }
    }
    sum += weight * terms[kind](place, cells, seedOf(index, i))
  })
  return sum
}

/** Φ(z) of the normal distribution to 0.01, as the shader has it. */
const cumulative = (z: number): number => 1 / (1 + Math.exp(-1.702 * z))

const encode = (z: number): number => Math.min(Math.max(0.5 + ENCODING_SCALE * z, 0), 1)

/** Float64 twin of `channelNoise`. */
export function channelNoise(channel: NoiseChannel, index: number, p: Vec3Array): number {
  const [mean, deviation] = channel.statistics
  const z = (channelSum(channel, index, p) - mean) / deviation
  return channel.encoding === 'uniform' ? cumulative(z) : encode(z)
}

/** Float64 twin of `curlNoise`: two components of a field without divergence, encoded in [0, 1]. */
export function curlNoise(index: number, p: Vec3Array): [number, number] {
  const [x, y] = curl(p, shapeCurl.cells, seedOf(index, 0))
  return [encode(x / shapeCurl.deviations[0]), encode(y / shapeCurl.deviations[1])]
}
