import type { Vector3 } from 'three'
import { Matrix3, Matrix4 } from 'three'
import type { Ellipsoid } from '@welkin/geo'

/**
 * The map of world space to the space in which the ellipsoid is a sphere of radius `bottomRadius`,
 * centred at the origin [m].
 */
export class SphericalSpace {
  /** World to mapped space. */
  readonly #matrix = new Matrix4()
  readonly #linear = new Matrix3()
  /** True if every position lies above the world's origin, at height y: a flat world. */
  flat = false

  /**
   * @param worldToECEF - Matrix from world units to metres in ECEF.
   * @param bottomRadius - Radius of the sphere [m].
   */
  set(worldToECEF: Matrix4, ellipsoid: Ellipsoid, bottomRadius: number): void {
    const { x, y, z } = ellipsoid.radii
    this.#matrix.makeScale(bottomRadius / x, bottomRadius / y, bottomRadius / z)
    this.#matrix.multiply(worldToECEF)
    this.#linear.setFromMatrix4(this.#matrix)
  }

  /** A position in the mapped space [m]. */
  position(world: Vector3, target: Vector3): Vector3 {
    target.copy(world)
    if (this.flat) target.x = target.z = 0
    return target.applyMatrix4(this.#matrix)
  }

  /** A direction in the mapped space, unit length. */
  direction(world: Vector3, target: Vector3): Vector3 {
    return target.copy(world).applyMatrix3(this.#linear).normalize()
  }

  /** The matrix for displacements, from a frame with the given axes in world space. */
  displacement(axes: Matrix4, target: Matrix3): Matrix3 {
    return target.setFromMatrix4(axes).premultiply(this.#linear)
  }
}
