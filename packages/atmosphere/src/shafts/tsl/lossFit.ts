import { vec2, vec3, vec4 } from 'three/tsl'
import { loop, type Float, type Int, type Vec3, type Vec4 } from '../../tsl-types'
import { depthWeight, type ShownAir } from './depthWeight'
import { depthOf, LEAST_RARITY, rarityAt, shownOf } from './rarity'

/** Part of the mean light by which lights must differ for the loss to follow them. Smaller: noise of depths. */
const LEAST_SPREAD = 0.01

/** Pixel around another: what it loses of the light that it shows, with its log₂ depth, and its share by place. */
interface Neighbour {
  readonly texel: Vec4
  readonly share: Float
}

/**
 * Part of its light that a pixel loses, by those around: a fit, linear in the light that air shows, in which pixels of alike
 * depth count most. So the edge of a cloud, through which a part of the light behind passes, loses that part of what the sky loses and
 * the rest of what the cloud does. Beyond the lights around nothing is known: there it is the part of the nearest.
 *
 * @param own - The pixel's air.
 * @param similar - Difference in light at which another counts half [octaves].
 * @returns The part, and the depth of the deepest around.
 */
export function lossFit(
  own: ShownAir,
  similar: number,
  neighbourAt: (corner: Int) => Neighbour
): { part: Vec3; deepest: Float } {
  const lost = vec3(0).toVar()
  const product = vec3(0).toVar()
  // Sums of weights, of lights, and of their squares.
  const sums = vec3(0).toVar()
  const range = vec2(1, 0).toVar()
  loop('corner', 4, corner => {
    const { texel, share } = neighbourAt(corner)
    const shown = shownOf(rarityAt(texel.w))
    const weight = depthWeight(own, { depth: texel.w, shown }, similar).mul(share).toConst()
    const each = texel.rgb.mul(shown.mul(weight)).toConst() as Vec3
    lost.addAssign(each)
    product.addAssign(each.mul(shown))
    sums.addAssign(vec3(1, shown, shown.mul(shown)).mul(weight))
    range.assign(vec2(range.x.min(shown), range.y.max(shown)))
  })
  const inverse = sums.x.reciprocal().toConst() as Float
  const means = vec4(lost, sums.y).mul(inverse).toConst() as Vec4
  const square = means.w.mul(means.w).toConst()
  const spread = sums.z
    .mul(inverse)
    .sub(square)
    .max(0)
    .add(square.mul(LEAST_SPREAD ** 2))
  const slope = product.mul(inverse).sub(means.rgb.mul(means.w)).div(spread)
  const shown = own.shown.clamp(range.x, range.y).toConst() as Float
  const part = means.rgb.add(slope.mul(shown.sub(means.w))).div(shown)
  const rarity = range.y.mul(range.y).reciprocal().sub(1).max(LEAST_RARITY) as Float
  return { part: part.toConst(), deepest: depthOf(rarity) }
}
