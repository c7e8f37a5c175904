import { MathUtils } from 'three'

/** Texels along an edge of what has octaves of noise. */
export const OCTAVES_SIDE = 256
/** Cells of the coarsest octave along an edge, and octaves. */
const CELLS = 8
const OCTAVES = 5

/** Pseudo-random number of a point of a lattice that repeats after a number of cells, in [0, 1). */
export function latticeHash(column: number, row: number, cells: number): number {
  let bits =
    Math.imul((column + cells) % cells, 0x27d4eb2d) ^ Math.imul((row + cells) % cells, 0x165667b1)
  bits = Math.imul(bits ^ (bits >>> 15) ^ cells, 0x2c1b3c6d)
  bits = Math.imul(bits ^ (bits >>> 12), 0x297a2d39)
  return ((bits ^ (bits >>> 15)) >>> 0) / 4294967296
}

/**
 * Five octaves of noise about 127.5, as texels of a square that repeats, row by row.
 *
 * @param noise - Noise about 0 at a place among so many cells, after which it repeats.
 * @param contrast - Greatest difference from the mean, for a coarsest octave of unit height [bytes].
 * @param aside - Way from the lattice to the first texel [texels]: noise that is 0 on it must not be looked up there in every octave.
 */
export function octaves(
  noise: (x: number, y: number, cells: number) => number,
  contrast: number,
  aside = 0
): Uint8Array {
  const bytes = new Uint8Array(OCTAVES_SIDE ** 2)
  for (let y = 0; y < OCTAVES_SIDE; y++) {
    for (let x = 0; x < OCTAVES_SIDE; x++) {
      let sum = 0
      for (let octave = 0; octave < OCTAVES; octave++) {
        const cells = CELLS * 2 ** octave
        const [u, v] = [x, y].map(t => ((t + aside) / OCTAVES_SIDE) * cells)
        sum += noise(u, v, cells) / 2 ** octave
      }
      bytes[y * OCTAVES_SIDE + x] = MathUtils.clamp(127.5 + sum * contrast, 0, 255)
    }
  }
  return bytes
}
