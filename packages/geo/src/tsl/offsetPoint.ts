import type { Node } from 'three/webgpu'

/** Place of a point about a sphere, as shader nodes. */
export interface OffsetPoint {
  /** Height above the sphere [m]. */
  height: Node<'float'>
  /** Distance from the sphere's centre [m]. */
  radius: Node<'float'>
  /** Zenith, unit length. */
  up: Node<'vec3'>
}

/**
 * Place of a point that is given by its offset from a viewpoint, without the cancellation of |p| − R:
 * with r_c = R + h_c, the point is (2 r_c (d·up) + |d|²) / (r + r_c) higher than the viewpoint.
 *
 * Height and zenith of the viewpoint come from the CPU, where float64 keeps their centimetres. On an
 * ellipsoid all vectors are in the space of `Ellipsoid.toSphere`.
 *
 * @param offset - Viewpoint to point, d [m].
 * @param up - Zenith at the viewpoint, unit length.
 * @param height - Viewpoint above the sphere, h_c [m].
 * @param sphereRadius - R [m].
 * @see Twin: test/twins/offsetPoint.ts
 */
export function offsetPoint(
  offset: Node<'vec3'>,
  up: Node<'vec3'>,
  height: Node<'float'>,
  sphereRadius: Node<'float'>
): OffsetPoint {
  const start = sphereRadius.add(height).toConst()
  const gain = offset.dot(up).mul(start).mul(2).add(offset.dot(offset)).toConst()
  const radius = start.mul(start).add(gain).max(1).sqrt().toConst()
  return {
    height: height.add(gain.div(radius.add(start))).toConst(),
    radius,
    up: up.mul(start).add(offset).div(radius).toConst()
  }
}
