import { Matrix4 } from 'three'
import type { Object3D } from 'three'
import { fail } from './check'

/**
 * World-to-ECEF matrix of a scene that holds a 3D Tiles globe: the inverse of its group's world
 * matrix, since tiles are in ECEF metres inside their group.
 *
 * ```ts
 * atmosphere.worldToECEF.copy(ecefFromTilesGroup(tiles.group))
 * const ellipsoid = Ellipsoid.from(tiles.ellipsoid)
 * ```
 *
 * @param group - `group` of a 3d-tiles-renderer `TilesRenderer`, moved, turned and uniformly scaled at
 *   will; its world matrix is brought up to date.
 * @returns World units to ECEF in metres.
 * @throws Error if the group's matrix has no inverse (a scale of 0).
 */
export function ecefFromTilesGroup(group: Object3D, target: Matrix4 = new Matrix4()): Matrix4 {
  if (!group?.isObject3D) fail('ecefFromTilesGroup', 'group must be an Object3D', group)
  group.updateWorldMatrix(true, false)
  const determinant = group.matrixWorld.determinant()
  if (!Number.isFinite(determinant) || determinant === 0) {
    fail('ecefFromTilesGroup', "the determinant of group's matrix must not be zero", determinant)
  }
  return target.copy(group.matrixWorld).invert()
}
