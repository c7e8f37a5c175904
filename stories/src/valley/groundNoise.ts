import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  MathUtils,
  RedFormat,
  RepeatWrapping,
  UnsignedByteType
} from 'three'

/** Texels along an edge. */
const SIZE = 256
/** Cells of the coarsest octave along an edge, and octaves. */
const CELLS = 8
const OCTAVES = 5
/** Greatest difference of the noise from its mean [bytes], for the coarsest octave of unit height. */
const CONTRAST = 147

const { lerp, smootherstep } = MathUtils

/** Pseudo-random slope of a lattice that repeats after a number of cells, along an offset from a point of it. */
function slopeAt(column: number, row: number, cells: number, dx: number, dy: number): number {
  let bits =
    Math.imul((column + cells) % cells, 0x27d4eb2d) ^ Math.imul((row + cells) % cells, 0x165667b1)
  bits = Math.imul(bits ^ (bits >>> 15) ^ cells, 0x2c1b3c6d)
  bits = Math.imul(bits ^ (bits >>> 12), 0x297a2d39)
  const angle = (((bits ^ (bits >>> 15)) >>> 0) / 4294967296) * 2 * Math.PI
  return Math.cos(angle) * dx + Math.sin(angle) * dy
}

/** Gradient noise that repeats after a number of cells, about in [−0.7, 0.7]. */
function gradientNoise(x: number, y: number, cells: number): number {
  const [column, row] = [Math.floor(x), Math.floor(y)]
  const [u, v] = [x - column, y - row]
  const across = smootherstep(u, 0, 1)
  const rows = [0, 1].map(j =>
    lerp(
      slopeAt(column, row + j, cells, u, v - j),
      slopeAt(column + 1, row + j, cells, u - 1, v - j),
      across
    )
  )
  return lerp(rows[0], rows[1], smootherstep(v, 0, 1))
}

/**
 * A tileable texture of five octaves of noise about 0.5, the same on every run.
 *
 * Its noise is of gradients: that of values has squares along the lattice, which on fields and slopes show as a net.
 */
export function createGroundNoise(): DataTexture {
  const data = new Uint8Array(SIZE * SIZE)
  for (let y = 0; y < SIZE; y++) {
    for (let x = 0; x < SIZE; x++) {
      let sum = 0
      for (let octave = 0; octave < OCTAVES; octave++) {
        const cells = CELLS * 2 ** octave
        // Beside the lattice, on which it is 0 in every octave.
        const [u, v] = [x, y].map(t => ((t + 0.37) / SIZE) * cells)
        sum += gradientNoise(u, v, cells) / 2 ** octave
      }
      data[y * SIZE + x] = MathUtils.clamp(127.5 + sum * CONTRAST, 0, 255)
    }
  }
  const result = new DataTexture(data, SIZE, SIZE, RedFormat, UnsignedByteType)
  result.wrapS = result.wrapT = RepeatWrapping
  result.magFilter = LinearFilter
  result.minFilter = LinearMipmapLinearFilter
  result.generateMipmaps = true
  result.needsUpdate = true
  return result
}
