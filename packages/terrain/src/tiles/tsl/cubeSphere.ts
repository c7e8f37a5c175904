import { Fn, vec3 } from 'three/tsl'
import { layout, type Float, type Vec3 } from '../../tsl-types'

/** The two axes along a face of the cube, by its number 0 to 5. Twin: ../cpu/cubeSphere.ts */
export function faceAxes(face: Float): { first: Vec3; second: Vec3 } {
  const axis = face.mul(0.5).floor().toConst()
  const sign = face.sub(axis.mul(2)).mul(-2).add(1)
  const isX = axis.lessThan(0.5).select(1, 0)
  const isZ = axis.greaterThan(1.5).select(1, 0)
  const isY = isX.add(isZ).oneMinus()
  return {
    first: vec3(isZ, isX, isY).mul(sign).toConst(),
    second: vec3(isY, isZ, isX).toConst()
  }
}

/**
 * Difference of two unit vectors, along w + δ and along w, without the cancellation of a plain difference:
 * exact to 1e-7 of itself, however close they are.
 *
 * (w + δ)/l′ − w/l = δ/l′ − w (l′² − l²) / (l l′ (l + l′)), with l′² − l² = 2 w·δ + δ².
 *
 * @param w - Any length but 0.
 * @param delta - δ.
 */
export const unitDifference = /*#__PURE__*/ Fn(
  ([w, delta]: [Vec3, Vec3]) => {
    const square = w.dot(w).toConst()
    const gain = w.dot(delta).mul(2).add(delta.dot(delta)).toConst()
    const length = square.sqrt().toConst()
    const other = square.add(gain).sqrt().toConst()
    const shrink = gain.div(length.mul(other).mul(length.add(other)))
    return delta.div(other).sub(w.mul(shrink))
  },
  layout('welkinUnitDifference', 'vec3', { w: 'vec3', delta: 'vec3' })
) as unknown as (w: Vec3, delta: Vec3) => Vec3
