import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  MathUtils,
  RedFormat,
  RepeatWrapping
} from 'three'

/** Texels along an edge. */
const SIZE = 256
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
 * A tileable texture of five octaves of noise about 0.5.
 *
 * @param noise - Noise about 0 at a place among so many cells, after which it repeats.
 * @param contrast - Greatest difference from the mean, for a coarsest octave of unit height [bytes].
 * @param aside - Way from the lattice to the first texel [texels]: noise that is 0 on it must not be looked up there in every octave.
 */
export function octaveTexture(
  noise: (x: number, y: number, cells: number) => number,
  contrast: number,
  aside = 0
): DataTexture {
  const data = new Uint8Array(SIZE * SIZE)
  for (let y = 0; y < SIZE; y++) {
    for (let x = 0; x < SIZE; x++) {
      let sum = 0
      for (let octave = 0; octave < OCTAVES; octave++) {
        const cells = CELLS * 2 ** octave
        const [u, v] = [x, y].map(t => ((t + aside) / SIZE) * cells)
        sum += noise(u, v, cells) / 2 ** octave
      }
      data[y * SIZE + x] = MathUtils.clamp(127.5 + sum * contrast, 0, 255)
    }
  }
  const result = new DataTexture(data, SIZE, SIZE, RedFormat)
  result.wrapS = result.wrapT = RepeatWrapping
  result.magFilter = LinearFilter
  result.minFilter = LinearMipmapLinearFilter
  result.generateMipmaps = true
  result.needsUpdate = true
  return result
}
