import { Vector3 } from 'three'

/** Axes of a face: outward, and two along it so that first × second is outward. */
export interface FaceAxes {
  readonly outward: Vector3
  readonly first: Vector3
  readonly second: Vector3
}

/** @param face - 0 to 5. Twin of `faceAxes` in a shader. */
export function faceAxes(face: number): FaceAxes {
  const axis = face >> 1
  const sign = 1 - 2 * (face & 1)
  const unit = (i: number, length: number): Vector3 =>
    new Vector3().setComponent((axis + i) % 3, length)
  return { outward: unit(0, sign), first: unit(1, sign), second: unit(2, 1) }
}

/**
 * Place of a point of the cube on the ellipsoid: the cube's point on the sphere, stretched by the radii. Without trigonometry, and
 * without poles and antimeridian.
 *
 * @param cube - Point on the cube of half width 1.
 * @param radii - Radii of the ellipsoid [m].
 * @returns ECEF [m].
 */
export const cubeToEllipsoid = (cube: Vector3, radii: Vector3, target: Vector3): Vector3 =>
  target.copy(cube).normalize().multiply(radii)
