import { MathUtils, type DataTexture } from 'three'
import { latticeHash, octaveTexture } from '../octaveTexture'

/** Greatest difference of the noise from its mean [bytes], for the coarsest octave of unit height. */
const CONTRAST = 147
/** Way from the lattice, on which noise of gradients is 0, to the first texel [texels]. */
const ASIDE = 0.37

const { lerp, smootherstep } = MathUtils

/** Pseudo-random slope of a lattice that repeats after a number of cells, along an offset from a point of it. */
function slopeAt(column: number, row: number, cells: number, dx: number, dy: number): number {
  const angle = latticeHash(column, row, cells) * 2 * Math.PI
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
export const createGroundNoise = (): DataTexture => octaveTexture(gradientNoise, CONTRAST, ASIDE)
