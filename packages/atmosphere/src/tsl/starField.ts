import { If, float, ivec2, textureLoad, vec2, vec4 } from 'three/tsl'
import type { DataTexture } from 'three'
import type { Float, Int, Vec3, Vec4 } from '../tsl-types'
import { loop, type Vec4Array } from '../tsl-types'
import { CELL_COLUMNS, CELLS, COLOR_STEPS, MAGNITUDE_RANGE, STAR_REACH } from '../stars/starCells'

/** Standard deviation of a star's picture, in pixels: its integral over them is right to 0.2 %. */
const SPREAD = 0.6

/** Standard deviations from its middle at which a star's picture ends. */
const EXTENT = 4.5

/** 10^(−0.4 m) = 2^(−c m). */
const MAGNITUDE_EXPONENT = 0.4 * Math.log2(10)

/** Number of the cell of the cube that a direction is in; the inverse of `facePoint`. */
function cellOf(direction: Vec3): Int {
  const size = direction.abs().toConst()
  const isX = size.x.greaterThanEqual(size.y).and(size.x.greaterThanEqual(size.z)).toConst()
  const isY = isX.not().and(size.y.greaterThanEqual(size.z)).toConst()
  const major = isX.select(direction.x, isY.select(direction.y, direction.z)).toConst()
  const first = isX.select(direction.y, isY.select(direction.z, direction.x))
  const second = isX.select(direction.z, isY.select(direction.x, direction.y))
  const face = isX.select(0, isY.select(2, 4)).add(major.lessThan(0).select(1, 0)).toInt()
  const slopes = vec2(first, second).div(major.abs().max(1e-6))
  const place = slopes.atan().mul(4 / Math.PI)
  const cell = place
    .mul(0.5)
    .add(0.5)
    .mul(CELLS)
    .floor()
    .clamp(0, CELLS - 1)
  const column = cell.x.toInt()
  const row = cell.y.toInt()
  return face.mul(CELLS).add(row).mul(CELLS).add(column).toConst()
}

/**
 * Radiance of the stars, each a Gaussian as wide as a pixel whose integral is the star's irradiance.
 *
 * @param cells - Texture of `starCells`.
 * @param palette - Irradiance by a star of magnitude 0 for each step of B − V.
 * @param direction - In the frame of the stars, unit length.
 * @param pixel - Angle that a pixel covers, as `fwidth` of a direction has it: its diagonal [rad].
 * @returns Radiance over `solarIrradiance` [1/sr].
 */
export function starField(
  cells: DataTexture,
  palette: Vec4Array,
  direction: Vec3,
  pixel: Float
): Vec4 {
  const texel = (index: Int): Vec4 =>
    textureLoad(cells, ivec2(index.mod(CELL_COLUMNS), index.div(CELL_COLUMNS)))
  // Pixels of more than 0.75° get a narrower star, which then falls between them at times.
  const widest = STAR_REACH / 3
  const sigma = pixel
    .mul(SPREAD / Math.SQRT2)
    .clamp(1e-6, widest)
    .toConst()
  const exponent = float(-0.5).div(sigma.mul(sigma)).toConst()
  const edge = sigma
    .mul(sigma)
    .mul(EXTENT * EXTENT)
    .toConst()
  const light = vec4(0).toVar()
  const cell = texel(cellOf(direction)).toConst() as Vec4
  loop('star', cell.y.toInt(), index => {
    const star = texel(cell.x.toInt().add(index)).toConst() as Vec4
    // The chord, not the cosine, which has no digits left for small angles.
    const chord = star.xyz.sub(direction).toConst()
    const square = chord.dot(chord).toConst()
    If(square.lessThan(edge), () => {
      const color = palette.element(
        star.w
          .floor()
          .clamp(0, COLOR_STEPS.count - 1)
          .toInt()
      )
      const magnitude = star.w.fract().mul(MAGNITUDE_RANGE.span).add(MAGNITUDE_RANGE.min)
      const brightness = magnitude.mul(-MAGNITUDE_EXPONENT).exp2()
      light.addAssign(color.mul(brightness.mul(square.mul(exponent).exp())))
    })
  })
  return light.mul(exponent.negate().div(Math.PI))
}
