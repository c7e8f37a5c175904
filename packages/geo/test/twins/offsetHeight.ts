import type { Vector3 } from 'three'

/**
 * Float64 twin of `tsl/offsetHeight`, by the plain difference |p| − R that the shader avoids.
 * Lengths [m].
 */
export function offsetHeight(
  offset: Vector3,
  up: Vector3,
  eyeHeight: number,
  radius: number
): number {
  return (
    up
      .clone()
      .multiplyScalar(radius + eyeHeight)
      .add(offset)
      .length() - radius
  )
}
