import { hashed } from '../terrain/vegetation/valueNoise'

/** Distance from the middle to the edge of the hills [m]. */
export const EXTENT = 60_000
/** Directions in which the grid of the hills has vertices. */
export const SECTORS = 600

/** Distances between which quads of the grid are shortest for their distance: hills stand there [m]. */
const [HILLS_FROM, HILLS_TO] = [1200, 16_000]

/** Periods of ridges [m], which are each a part of the one before, in height too. */
const LONGEST = 6800
const FINER = 2.1
const LOWER = 0.47
const OCTAVES = 7

/** Height of the longest ridges [m]. */
const HIGHEST = 640

/** Quads that a period needs at least. Fewer: crests are teeth, which comb light shafts of a low sun. */
const PERIOD_QUADS = 4

/** Quads over which crests are round. Less: where they cross the grid askew they are teeth, too. */
const ROUND = 1.2

const fade = (t: number): number => t * t * t * (t * (6 * t - 15) + 10)
const clamp = (t: number): number => Math.min(Math.max(t, 0), 1)

/** Directions of gradients, x and y in turn. */
const DIRECTIONS = 256
const gradients = Float64Array.from({ length: 2 * DIRECTIONS }, (_, i) => {
  const angle = (2 * Math.PI * (i >> 1)) / DIRECTIONS
  return i % 2 === 0 ? Math.cos(angle) : Math.sin(angle)
})

/** Height at a way (x, y) from a corner of the lattice, along its gradient. */
function fromCorner(i: number, j: number, seed: number, x: number, y: number): number {
  const n = 2 * Math.floor(DIRECTIONS * hashed(i, j, seed))
  return gradients[n] * x + gradients[n + 1] * y
}

/** Gradient noise (Perlin 2002) with unit cells, about ±0.7: unlike noise of values it has no flat steps along its lattice. */
function gradientNoise(x: number, y: number, seed: number): number {
  const i = Math.floor(x)
  const j = Math.floor(y)
  const s = x - i
  const t = y - j
  const u = fade(s)
  const v = fade(t)
  const a = fromCorner(i, j, seed, s, t)
  const b = fromCorner(i + 1, j, seed, s - 1, t)
  const c = fromCorner(i, j + 1, seed, s, t - 1)
  const d = fromCorner(i + 1, j + 1, seed, s - 1, t - 1)
  const near = a + u * (b - a)
  return near + v * (c + u * (d - c) - near)
}

/** Length of the grid's quads away from the middle, at a distance from it [m]. */
export function ringStep(distance: number): number {
  const part = distance < HILLS_FROM ? 0.07 : distance < HILLS_TO ? 0.02 : 0.035
  return Math.max(part * distance, 2)
}

/** Low swells of the level middle, by which one sees its fields; none at the camera [m]. */
function swell(x: number, z: number, distance: number): number {
  const part = clamp((distance - 40) / 400)
  const noise = gradientNoise(x / 380 + 40, z / 380, 50) + 0.3 * gradientNoise(x / 150, z / 150, 51)
  return 13 * part * part * (3 - 2 * part) * noise
}

/**
 * Height of the hills [m]: a ridged multifractal (Musgrave 1998) of octaves that the grid can hold, with smooth valleys and spurs towards
 * them, nearly level within 1.5 km of the middle.
 */
export function hillHeight(x: number, z: number): number {
  const distance = Math.hypot(x, z)
  const rise = clamp((distance - 1500) / 6000)
  const low = -2 + swell(x, z, distance) * (1 - rise)
  if (rise === 0) return low
  const spacing = Math.max(ringStep(distance), (2 * Math.PI * distance) / SECTORS)
  // Bent, so that crests are not of one width and do not run straight.
  const bentX = x + 1500 * gradientNoise(x / 4700, z / 4700, 21)
  const bentZ = z + 1500 * gradientNoise(x / 4700, z / 4700, 22)
  let [sum, weight, high, period] = [0, 1, 1, LONGEST]
  for (let octave = 0; octave < OCTAVES; octave++) {
    const part = clamp((2 * period) / (PERIOD_QUADS * spacing) - 1)
    if (part === 0) break
    const noise = 1.5 * gradientNoise(bentX / period, bentZ / period, octave)
    const ridge = Math.max(1 - Math.hypot(noise, (3 * ROUND * spacing) / period), 0) ** 2
    sum += part * high * weight * ridge
    weight = clamp(1.5 * ridge * weight)
    high *= LOWER
    period /= FINER
  }
  return low + HIGHEST * rise * sum
}
