import { If, float, ivec2, textureLoad, vec4 } from 'three/tsl'
import type { DataTexture } from 'three'
import type { Float, Int, Vec3, Vec4 } from '../../tsl-types'
import { loop, type Vec4Array } from '../../tsl-types'
import { COLOR_STEPS, ENTRY_COLUMNS, MAGNITUDE_RANGE, STAR_LEVELS } from '../starCells'
import { octahedralPoint } from '../../math/tsl/octahedron'

/** Standard deviation of a star's image [pixels]: its pixels add up to its light within 0.2 %. */
const SIGMA_PIXELS = 0.6

/** Standard deviations from its centre at which a star's image ends. */
const CUTOFF_SIGMAS = 4.5

/** c of 10^(−0.4 m) = 2^(−c m). */
const MAGNITUDE_EXPONENT = 0.4 * Math.log2(10)

/** Largest standard deviation of a star's image that the small cells serve [rad]. */
const MAX_SIGMA_SMALL = STAR_LEVELS[0].margin / CUTOFF_SIGMAS

/** Largest standard deviation of a star's image, cut off at three of them [rad]. */
const MAX_SIGMA = STAR_LEVELS[1].margin / 3

/** Textures of `starCells`. */
export interface StarTextures {
  cells: DataTexture
  entries: DataTexture
}

/**
 * Stars that can shine in a direction: texel (first entry, number of entries) of its cell.
 *
 * @param sigma - Standard deviation of a star's image [rad].
 */
function starsOfCell(cells: DataTexture, direction: Vec3, sigma: Float): Vec4 {
  const [small, large] = STAR_LEVELS
  const isLarge = sigma.greaterThan(MAX_SIGMA_SMALL).toConst()
  const size = isLarge.select(large.cells, small.cells).toConst() as Float
  const position = octahedralPoint(direction).add(1).mul(size.mul(0.5)).clamp(0, size.sub(1))
  const firstRow = isLarge.select(small.cells, 0).toInt()
  return textureLoad(cells, ivec2(position).add(ivec2(0, firstRow))).toConst()
}

/** Texel (unit vector, `packStar`) of an entry. */
function starEntry(entries: DataTexture, index: Int): Vec4 {
  const column = index.bitAnd(ENTRY_COLUMNS - 1)
  const row = index.shiftRight(Math.log2(ENTRY_COLUMNS))
  return textureLoad(entries, ivec2(column, row)).toConst()
}

/**
 * Brightness of a star by its magnitude, in its colour.
 *
 * @param packed - `packStar`.
 */
function starBrightness(palette: Vec4Array, packed: Float): Vec4 {
  const step = packed
    .floor()
    .clamp(0, COLOR_STEPS.count - 1)
    .toInt()
  const magnitude = packed.fract().mul(MAGNITUDE_RANGE.span).add(MAGNITUDE_RANGE.min)
  return palette.element(step).mul(magnitude.mul(-MAGNITUDE_EXPONENT).exp2())
}

/**
 * Radiance of the stars: each is a Gaussian about a pixel wide that integrates to the star's irradiance.
 *
 * @param palette - Irradiance by a star of magnitude 0 for each step of B − V.
 * @param direction - In the stars' frame (J2000), of any length.
 * @param pixel - Angle across the diagonal of a pixel, as `fwidth` of a direction has it [rad].
 * @returns Radiance over `solarIrradiance` [1/sr].
 */
export function starField(
  { cells, entries }: StarTextures,
  palette: Vec4Array,
  direction: Vec3,
  pixel: Float
): Vec4 {
  // Pixels of more than 0.75° get a narrower image, which at times falls between them.
  const sigma = pixel
    .mul(SIGMA_PIXELS / Math.SQRT2)
    .clamp(1e-6, MAX_SIGMA)
    .toConst() as Float
  const list = starsOfCell(cells, direction, sigma)
  const light = vec4(0).toVar()
  If(list.y.greaterThan(0), () => {
    const unit = direction.normalize().toConst()
    const square = sigma.mul(sigma).toConst()
    const exponent = float(-0.5).div(square).toConst()
    const cutoff = square.mul(CUTOFF_SIGMAS * CUTOFF_SIGMAS).toConst()
    const first = list.x.toInt().toConst() as Int
    loop('star', list.y.toInt(), index => {
      const star = starEntry(entries, first.add(index).toConst())
      // The chord, not the cosine, which has no digits left for small angles.
      const chord = star.xyz.sub(unit).toConst()
      const squareDistance = chord.dot(chord).toConst()
      If(squareDistance.lessThan(cutoff), () => {
        const brightness = starBrightness(palette, star.w)
        light.addAssign(brightness.mul(squareDistance.mul(exponent).exp()))
      })
    })
    light.mulAssign(exponent.negate().div(Math.PI))
  })
  return light
}
