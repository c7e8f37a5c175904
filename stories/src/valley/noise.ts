import { MathUtils } from 'three'

/** Pseudo-random direction of a lattice point: a gradient. */
function gradient(column: number, row: number, x: number, y: number): number {
  let bits = Math.imul(column, 0x27d4eb2d) ^ Math.imul(row, 0x165667b1)
  bits = Math.imul(bits ^ (bits >>> 15), 0x2c1b3c6d)
  bits ^= bits >>> 12
  const angle = ((bits >>> 0) / 4294967296) * 2 * Math.PI
  return Math.cos(angle) * x + Math.sin(angle) * y
}

const { clamp, lerp, smootherstep } = MathUtils

/** Gradient noise with unit cells, about in [−0.7, 0.7]. */
export function smoothNoise(x: number, y: number): number {
  const [column, row] = [Math.floor(x), Math.floor(y)]
  const [u, v] = [x - column, y - row]
  const across = smootherstep(u, 0, 1)
  const near = lerp(gradient(column, row, u, v), gradient(column + 1, row, u - 1, v), across)
  const far = lerp(
    gradient(column, row + 1, u, v - 1),
    gradient(column + 1, row + 1, u - 1, v - 1),
    across
  )
  return lerp(near, far, smootherstep(v, 0, 1))
}

/** Mean height of a ridge of unit height. */
export const MEAN_RIDGE = 0.6

/** Height over which mountains are rounded off, so that none is cut flat. */
export const ROUNDED = 0.72

/**
 * Mountains of unit width, in [0, 1]: ridges whose finer ones stand on the coarser.
 *
 * @param finest - Width of the finest ridges: on a coarse grid, finer ones are streaks.
 * @see Musgrave 1993, "Methods for realistic landscape imaging" §2.3.2, ridged multifractal
 */
export function ridges(x: number, y: number, finest: number): number {
  const u = x + 0.22 * smoothNoise(1.7 * x + 5, 1.7 * y)
  const v = y + 0.22 * smoothNoise(1.7 * x, 1.7 * y + 9)
  let sum = 0
  let weight = 1
  let amplitude = 0.5
  let scale = 1
  for (let octave = 0; octave < 8; octave++) {
    const ridge =
      (1 - Math.abs(1.4 * smoothNoise(u * scale + 17 * octave, v * scale - 9 * octave))) ** 2
    const isShown = clamp(1 / (finest * scale) - 1, 0, 1)
    // The mean of ridges that are left out stays.
    sum += amplitude * weight * lerp(MEAN_RIDGE, ridge, isShown)
    weight = clamp(1.6 * ridge * weight, 0, 1)
    amplitude *= 0.5
    scale *= 2.03
  }
  const above = Math.max(sum - ROUNDED, 0) / (1 - ROUNDED)
  return Math.min(sum, ROUNDED) + (1 - ROUNDED) * (1 - Math.exp(-above))
}
