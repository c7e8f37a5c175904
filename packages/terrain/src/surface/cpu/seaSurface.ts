import { PERIOD, SEA_WAVES, WAVE_SLOPE } from '../seaWaves'

type Vector = readonly [number, number, number]

const dot = (a: Vector, b: Vector): number => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

/** Refractive index of water. */
const INDEX = 1.34

/** Float64 twin of the reflectance of rough water: at a mean slope, by a power in place of products. */
export function waterFresnel(cosViewer: number, variance: number): number {
  const mean = Math.min(Math.hypot(cosViewer, Math.sqrt(variance)), 1)
  const normal = ((INDEX - 1) / (INDEX + 1)) ** 2
  return normal + (1 - normal) * (1 - mean) ** 5
}

/**
 * Float64 twin of the waves: slopes along the ground, and the variance of those that they do not resolve.
 *
 * @param offset - Place relative to a multiple of 256 m [m].
 * @param up - Unit vector.
 * @param footprint - Longer side of the pixel on the ground [m].
 * @param seaVariance - Variance of all slopes.
 * @param seconds - Time of the waves [s].
 */
export function seaWaves(
  offset: Vector,
  up: Vector,
  footprint: number,
  seaVariance: number,
  seconds: number
): { slope: Vector; variance: number } {
  const slope = [0, 0, 0]
  let shown = 0
  for (const { vector, length, frequency } of SEA_WAVES) {
    const direction = vector.map(part => (part * length) / PERIOD) as unknown as Vector
    const steepest = Math.sqrt(seaVariance) * WAVE_SLOPE * Math.max(1 - footprint / length, 0)
    const phase = 2 * Math.PI * (dot(direction, offset) / length - frequency * seconds)
    const upward = dot(direction, up)
    for (let i = 0; i < 3; i++) {
      slope[i] += steepest * Math.cos(phase) * (direction[i] - upward * up[i])
    }
    // Two thirds of its square lie along the ground, and half of that is its mean.
    shown += steepest ** 2 / 3
  }
  return { slope: slope as unknown as Vector, variance: seaVariance - shown }
}
