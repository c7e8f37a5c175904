import { If, float, ivec2, textureLoad, vec4 } from 'three/tsl'
import type { DataTexture } from 'three'
import type { Float, Int, Vec3, Vec4 } from '../../tsl-types'
import { loop, type Vec4Array } from '../../tsl-types'
import { COLOR_STEPS, ENTRY_COLUMNS, MAGNITUDE_RANGE, STAR_LEVELS } from '../starCells'
import { octahedralPoint } from '../../math/tsl/octahedron'

/** Standard deviation of a star's picture, in pixels: its integral over them is right to 0.2 %. */
const SPREAD = 0.6

/** Standard deviations from its middle at which a star's picture ends. */
const EXTENT = 4.5

/** 10^(−0.4 m) = 2^(−c m). */
const MAGNITUDE_EXPONENT = 0.4 * Math.log2(10)

/** Widest standard deviations of a star's picture for each of the levels of cells. */
const [WIDEST_SMALL, WIDEST] = [STAR_LEVELS[0].reach / EXTENT, STAR_LEVELS[1].reach / 3] as const

/** What {@link starField} reads: textures of `starCells`. */
export interface StarTextures {
  cells: DataTexture
  entries: DataTexture
}

/**
 * Radiance of the stars, each a Gaussian as wide as a pixel whose integral is the star's irradiance.
 *
 * @param palette - Irradiance by a star of magnitude 0 for each step of B − V.
 * @param direction - In the frame of the stars, of any length.
 * @param pixel - Angle that a pixel covers, as `fwidth` of a direction has it: its diagonal [rad].
 * @returns Radiance over `solarIrradiance` [1/sr].
 */
export function starField(
  { cells, entries }: StarTextures,
  palette: Vec4Array,
  direction: Vec3,
  pixel: Float
): Vec4 {
  const [small, large] = STAR_LEVELS
  // Pixels of more than 0.75° get a narrower star, which then falls between them at times.
  const sigma = pixel
    .mul(SPREAD / Math.SQRT2)
    .clamp(1e-6, WIDEST)
    .toConst()
  const isLarge = sigma.greaterThan(WIDEST_SMALL).toConst()
  const size = isLarge.select(large.cells, small.cells).toConst() as Float
  const place = octahedralPoint(direction).add(1).mul(size.mul(0.5)).clamp(0, size.sub(1))
  const row = isLarge.select(small.cells, 0).toInt()
  const cell = ivec2(place).add(ivec2(0, row))
  const list = textureLoad(cells, cell).toConst() as unknown as Vec4
  const light = vec4(0).toVar()
  If(list.y.greaterThan(0), () => {
    const unit = direction.normalize().toConst()
    const square = sigma.mul(sigma).toConst()
    const exponent = float(-0.5).div(square).toConst()
    const edge = square.mul(EXTENT * EXTENT).toConst()
    const first = list.x.toInt().toConst() as Int
    loop('star', list.y.toInt(), index => {
      const entry = first.add(index).toConst()
      const column = entry.bitAnd(ENTRY_COLUMNS - 1)
      const row = entry.shiftRight(Math.log2(ENTRY_COLUMNS))
      const star = textureLoad(entries, ivec2(column, row)).toConst() as unknown as Vec4
      // The chord, not the cosine, which has no digits left for small angles.
      const chord = star.xyz.sub(unit).toConst()
      const apart = chord.dot(chord).toConst()
      If(apart.lessThan(edge), () => {
        const color = palette.element(
          star.w
            .floor()
            .clamp(0, COLOR_STEPS.count - 1)
            .toInt()
        )
        const magnitude = star.w.fract().mul(MAGNITUDE_RANGE.span).add(MAGNITUDE_RANGE.min)
        const brightness = magnitude.mul(-MAGNITUDE_EXPONENT).exp2()
        light.addAssign(color.mul(brightness.mul(apart.mul(exponent).exp())))
      })
    })
    light.mulAssign(exponent.negate().div(Math.PI))
  })
  return light
}
