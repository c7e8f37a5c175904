import { MathUtils, RGFormat, type DataTexture } from 'three'
import { tileable } from '../mipmapped'
import { latticeHash, octaves, OCTAVES_SIDE } from '../octaves'

/** Greatest difference of the noise from its mean [bytes], for the coarsest octave of unit height. */
const CONTRAST = 147
/** Way from the lattice, on which noise of gradients is 0, to the first texel [texels]. */
const ASIDE = 0.37

const { clamp, lerp, smootherstep } = MathUtils

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

/** Crowns along an edge of the picture of a wood, and their greatest way from the middle of their place, over its width. */
const CROWNS = 16
const STRAY = 0.36
/** Radii of crowns over the width of their place, and their least height. */
const RADII = [0.65, 1] as const
const LEAST = 0.45
/** Unevenness of their outlines by the noise. */
const RAGGED = 0.55
/** Greatest difference of a crown's height from the mean over its height [bytes]. */
const RISE = 190

/** A crown: the place of its top among the squares of a grid, its radius in these, and its height in [0, 1]. */
type Crown = readonly [x: number, y: number, radius: number, height: number]

/** Crowns of a wood that repeats after {@link CROWNS} squares, one in each. */
function crownsOfWood(): Crown[] {
  return Array.from({ length: CROWNS * CROWNS }, (_, i): Crown => {
    const [column, row] = [i % CROWNS, Math.floor(i / CROWNS)]
    const chance = (seed: number): number => latticeHash(column + seed, row + 3 * seed, CROWNS)
    const [x, y] = [column, row].map((at, side) => at + 0.5 + STRAY * (2 * chance(side) - 1))
    return [x, y, lerp(...RADII, chance(5)), lerp(LEAST, 1, chance(7))]
  })
}

/** Height of the highest crown over a place, in [0, 1]: crowns are cones. */
function crownHeight(crowns: readonly Crown[], x: number, y: number, noise: number): number {
  const [column, row] = [Math.floor(x), Math.floor(y)]
  let highest = 0
  for (let j = row - 1; j <= row + 1; j++) {
    for (let i = column - 1; i <= column + 1; i++) {
      const [wrappedX, wrappedY] = [(i + CROWNS) % CROWNS, (j + CROWNS) % CROWNS]
      const [topX, topY, radius, height] = crowns[wrappedY * CROWNS + wrappedX]
      const distance = Math.hypot(x - topX - i + wrappedX, y - topY - j + wrappedY)
      highest = Math.max(highest, height * (1 - distance / (radius * (1 + RAGGED * noise))))
    }
  }
  return highest
}

/**
 * A tileable texture: in red five octaves of noise about 0.5, in green crowns of a wood, about 0.5 as well; the same on every run.
 *
 * Its noise is of gradients: that of values has squares along the lattice, which on fields and slopes show as a net.
 */
export function createGroundNoise(): DataTexture {
  const grain = octaves(gradientNoise, CONTRAST, ASIDE)
  const crowns = crownsOfWood()
  const scale = CROWNS / OCTAVES_SIDE
  const heights = Float32Array.from(grain, (noise, i) => {
    const [column, row] = [i % OCTAVES_SIDE, Math.floor(i / OCTAVES_SIDE)]
    return crownHeight(crowns, column * scale, row * scale, noise / 127.5 - 1)
  })
  const mean = heights.reduce((sum, height) => sum + height, 0) / heights.length
  const texels = new Uint8Array(2 * grain.length)
  for (const [i, height] of heights.entries()) {
    texels[2 * i] = grain[i]
    texels[2 * i + 1] = clamp(127.5 + (height - mean) * RISE, 0, 255)
  }
  return tileable(texels, OCTAVES_SIDE, RGFormat)
}
