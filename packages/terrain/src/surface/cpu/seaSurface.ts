import { PERIOD, SEA_WAVES, WARP, WARPED, WARPS, WAVE_SLOPE } from '../seaWaves'

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
  const phases = WARPS.map(warp => (2 * Math.PI * dot(warp, offset)) / PERIOD)
  const warped = offset.map((part, i) => part + WARP * Math.sin(phases[i])) as unknown as Vector
  const slope = [0, 0, 0]
  let shown = 0
  for (const { vector, length, frequency } of SEA_WAVES) {
    const direction = vector.map(part => (part * length) / PERIOD) as unknown as Vector
    const steepest = Math.sqrt(seaVariance) * WAVE_SLOPE * Math.max(1 - footprint / length, 0)
    const phase = 2 * Math.PI * (dot(direction, warped) / length - frequency * seconds)
    // Derivative of the warped direction's phase along each axis.
    const turned = direction.map((part, axis) =>
      WARPS.reduce(
        (sum, warp, i) =>
          sum + direction[i] * WARP * Math.cos(phases[i]) * ((2 * Math.PI * warp[axis]) / PERIOD),
        part
      )
    ) as unknown as Vector
    const upward = dot(turned, up)
    for (let i = 0; i < 3; i++) {
      slope[i] += steepest * Math.cos(phase) * (turned[i] - upward * up[i])
    }
    // Two thirds of its square lie along the ground, and half of that is its mean.
    shown += (WARPED * steepest ** 2) / 3
  }
  return { slope: slope as unknown as Vector, variance: seaVariance - shown }
}
