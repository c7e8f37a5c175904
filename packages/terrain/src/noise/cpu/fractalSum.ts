import { latticeNoise, type Noise } from './latticeNoise'

/** Sum of octaves, with its gradient [1/m]. */
export type Sum = Noise

/** Octaves of noise: wavelengths are halved from one to the next. */
export interface Octaves {
  /** Number of octaves. */
  readonly count: number
  /** 1 / wavelength of the first, a power of two [1/m]. */
  readonly inverse: number
  /** Amplitude of an octave per that of the one before [–]. */
  readonly gain: number
  /** Seed of the first; each next one has the next. */
  readonly seed: number
}

const noise: Noise = { x: 0, y: 0, z: 0, value: 0 }

/**
 * Fractal sum of noise, at full detail. Twin of the shader's.
 *
 * @param x - ECEF [m], like `y` and `z`.
 * @param seed - Added to that of the octaves.
 */
export function fractalSum(
  x: number,
  y: number,
  z: number,
  octaves: Octaves,
  seed: number,
  target: Sum
): Sum {
  const { count, inverse, gain } = octaves
  target.x = target.y = target.z = target.value = 0
  for (let i = 0; i < count; i++) {
    const scale = inverse * 2 ** i
    const amplitude = gain ** i
    latticeNoise(x, y, z, scale, octaves.seed + seed + i, noise)
    target.value += amplitude * noise.value
    target.x += amplitude * scale * noise.x
    target.y += amplitude * scale * noise.y
    target.z += amplitude * scale * noise.z
  }
  return target
}
