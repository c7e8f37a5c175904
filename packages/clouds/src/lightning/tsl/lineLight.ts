import { Fn, atan } from 'three/tsl'
import { layout, type Float, type Vec3 } from '../../tsl-types'

/**
 * Angle atan((L − a)/b) + atan(a/b) under which a line is seen [rad], by one arctangent.
 *
 * @param b - Distance from the line's axis [m], and `square` of it.
 * @param foot - a, place of the foot on the line, of `length` L [m].
 */
export const lineAngle = (b: Float, square: Float, foot: Float, length: Float): Float =>
  atan(b.mul(length), square.sub(foot.mul(length.sub(foot))))

/**
 * Mean of 1/(r² + s²) over a straight line, r the distance to a place [1/m²].
 *
 * With b² = h² + s², h the distance to the line's axis: [atan((L − a)/b) + atan(a/b)] / (b L), a the foot's place on a line of length L. It
 * is both the light of a line at a place, and that of a place in the air along a ray. Twin: test/twins/lightning.ts
 *
 * @param start - Displacement from the place to the line's begin [m].
 * @param end - Displacement from the place to its end [m].
 * @param softness - s > 0 [m].
 */
export const meanInverseSquare = /*#__PURE__*/ Fn(
  ([start, end, softness]: [Vec3, Vec3, Float]) => {
    const line = end.sub(start).toConst() as Vec3
    const length = line.length().max(1).toConst() as Float
    const foot = start.dot(line).div(length).negate().toConst() as Float
    const aside = start.add(line.mul(foot.div(length))).toConst() as Vec3
    const b = aside.dot(aside).add(softness.mul(softness)).sqrt().toConst() as Float
    return lineAngle(b, b.mul(b), foot, length).div(b.mul(length))
  },
  layout('meanInverseSquare', 'float', { start: 'vec3', end: 'vec3', softness: 'float' })
)
