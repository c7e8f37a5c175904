import { Fn, If, float, floor, int, ivec2, luminance, textureLoad, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { loop, type Float, type Int, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import { meterForm } from '../cpu/meteredLuminance'

const { taps, darkest, brightest } = meterForm

/**
 * Mean log2 luminance in the four quadrants of a cell of a picture. Of each, 4 × 4 pixels on a lattice count.
 *
 * The logarithm is taken before the mean: a pixel of the sun has no more weight than others. Pixels that are
 * black or not a number do not count, those above what half floats hold count as that.
 *
 * @param picture - Linear colour.
 * @param size - Size of the picture [pixels].
 * @param cell - Lower corner of the cell, in [0, 1)².
 * @param extent - Size of the cell, in (0, 1]².
 * @returns log2 of luminance in the picture's own unit, in [−24, 16]; −24 where nothing counts.
 */
export const logLuminance = (picture: TextureNode, size: Vec2, cell: Vec2, extent: Vec2): Vec4 =>
  Fn(() => {
    const quadrants = [0, 1, 2, 3].map(quadrant => {
      const corner = vec2(quadrant % 2, quadrant >> 1).div(2)
      const sum = vec2(0).toVar()
      loop(`tap${quadrant}`, taps * taps, (tap: Int) => {
        const offset = vec2(tap.mod(int(taps)), tap.div(int(taps)))
          .add(0.5)
          .div(2 * taps)
        const uv = cell.add(extent.mul(corner.add(offset)))
        const texel = ivec2(floor(uv.mul(size)))
        const { rgb } = textureLoad(picture, texel) as unknown as { rgb: Vec3 }
        const value = (luminance(rgb) as unknown as Float).toConst() as Float
        // False for what is not a number.
        If(value.greaterThan(2 ** darkest), () => {
          sum.addAssign(vec2(value.min(2 ** brightest).log2(), 1))
        })
      })
      const mean = sum.x.div(sum.y.max(1))
      return sum.y.greaterThan(0).select(mean, float(darkest))
    })
    return vec4(...(quadrants as [Float, Float, Float, Float]))
  })()
