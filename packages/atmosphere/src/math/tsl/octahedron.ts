import { float, vec2, vec3 } from 'three/tsl'
import type { Float, Vec2, Vec3 } from '../../tsl-types'

const signs = (of: Vec2): Vec2 =>
  vec2(of.x.lessThan(0).select(-1, 1), of.y.lessThan(0).select(-1, 1))

const fold = (point: Vec2): Vec2 => vec2(point.y, point.x).abs().oneMinus().mul(signs(point))

/**
 * Point of a direction on a square map of all directions, the net of an octahedron: the upper half in a
 * diamond, the lower half folded out into the corners.
 *
 * @param direction - Not zero, of any length.
 * @returns Each in [−1, 1]; the middle is +Z, the corners are −Z.
 * @see Cigolle et al. 2014, "A survey of efficient representations for independent unit vectors", "oct".
 *   Twin: cpu/octahedron.ts
 */
export function octahedralPoint(direction: Vec3): Vec2 {
  const size = direction.abs().toConst()
  const point = direction.xy.div(size.x.add(size.y).add(size.z)).toConst() as Vec2
  return direction.z.lessThan(0).select(fold(point), point).toConst()
}

/** The inverse of {@link octahedralPoint}, of unit length. */
export function octahedralDirection(point: Vec2): Vec3 {
  const size = point.abs().toConst()
  const z = float(1).sub(size.x).sub(size.y).toConst() as Float
  const xy = z.lessThan(0).select(fold(point), point)
  return vec3(xy, z).normalize().toConst()
}
