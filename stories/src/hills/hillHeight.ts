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

/** Quads that a period needs at least. Fewer: crests are teeth, which comb light shafts of a low sun. */
const PERIOD_QUADS = 4

/** Quads over which crests are round. Less: where they cross the grid askew they are teeth, too. */
const ROUND = 1.2

const fade = (t: number): number => t * t * t * (t * (6 * t - 15) + 10)
const clamp = (t: number): number => Math.min(Math.max(t, 0), 1)

/** Gradient noise (Perlin 2002) with unit cells, about ±0.7: unlike noise of values it has no flat steps along its lattice. */
function gradientNoise(x: number, y: number, seed: number): number {
  const [i, j] = [Math.floor(x), Math.floor(y)]
  const [s, t] = [x - i, y - j]
  const corner = (a: number, b: number): number => {
    const angle = 2 * Math.PI * hashed(i + a, j + b, seed)
    return Math.cos(angle) * (s - a) + Math.sin(angle) * (t - b)
  }
  const [u, v] = [fade(s), fade(t)]
  const near = corner(0, 0) * (1 - u) + corner(1, 0) * u
  return near * (1 - v) + (corner(0, 1) * (1 - u) + corner(1, 1) * u) * v
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
  return low + 900 * rise * sum
}
