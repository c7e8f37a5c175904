import type { Vector3 } from 'three'

/** Float64 twin of `tsl/offsetPoint`, by the plain difference |p| − R that the shader avoids [m]. */
export function offsetPoint(
  offset: Vector3,
  up: Vector3,
  height: number,
  sphereRadius: number
): { height: number; radius: number; up: Vector3 } {
  const point = up
    .clone()
    .multiplyScalar(sphereRadius + height)
    .add(offset)
  const radius = point.length()
  return { height: radius - sphereRadius, radius, up: point.normalize() }
}
