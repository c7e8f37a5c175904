import { If, min, vec3 } from 'three/tsl'
import type { Bool, Float, Vec3, Vec4 } from '../../tsl-types'
import type { Backdrop } from '../Backdrop'

/** Linear colour below which a backdrop is as good as black. */
const BLACK = 1e-4

/** Colour and coverage of a pixel's objects, without the backdrop. */
export interface Foreground {
  /** Linear colour times {@link coverage}. */
  light: Vec3
  /** Part of the pixel that it covers, in [0, 1]. */
  coverage: Float
}

/**
 * Takes a pixel's backdrop off. A backdrop that is not opaque leaves the foreground's coverage in alpha.
 * Over an opaque one what writes no depth counts as covering the least that explains the colour, since
 * light cannot be negative: over black nothing, so that it adds its light to the sky.
 *
 * @param color - Linear, of what was drawn over the backdrop.
 * @param isEmpty - True if nothing wrote depth here.
 */
export function foregroundOf(color: Vec4, isEmpty: Bool, backdrop: Backdrop): Foreground {
  const clear = backdrop.color as unknown as Vec4
  const coverage = color.a.sub(clear.a).div(clear.a.oneMinus().max(1e-6)).clamp().toVar() as Float
  If(clear.a.greaterThanEqual(1), () => {
    coverage.assign(1)
    If(isEmpty, () => {
      const left = color.rgb.add(BLACK).div(clear.rgb.add(BLACK)).toConst()
      coverage.assign(min(left.x, left.y, left.z).clamp().oneMinus())
    })
  })
  const light = color.rgb.sub(clear.rgb.mul(coverage.oneMinus())).max(0).toVar()
  // A background picture, or a target that somebody else cleared.
  If(backdrop.isKnown.equal(0).and(isEmpty).and(color.a.greaterThanEqual(1)), () => {
    coverage.assign(0)
    light.assign(vec3(0))
  })
  return { light, coverage }
}
