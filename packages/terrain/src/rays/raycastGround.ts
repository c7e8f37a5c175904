import { Matrix3, Vector3 } from 'three'
import type { Intersection, Object3D, Raycaster } from 'three'
import { distanceToGround } from './distanceToGround'
import { figureOf, worldToGround } from '../tiles/cpu/figure'
import { groundNormal, type Ground } from './Ground'

const origin = new Vector3()
const direction = new Vector3()
const subpoint = new Vector3()
const axes = new Matrix3()

/**
 * Adds the nearest hit of a ray on the ground or the sea to three's list.
 *
 * @param ground - Object that is hit.
 * @param raycaster - Ray in the world, with `near` and `far`.
 * @param intersects - Receives distance [units], point in the world, and normal in the object's own axes, those of ECEF.
 */
export function raycastGround(
  ground: Ground & Object3D,
  { ray, near, far }: Raycaster,
  intersects: Intersection[]
): void {
  const fromWorld = worldToGround(ground.atmosphere)
  origin.copy(ray.origin).applyMatrix4(fromWorld)
  direction.copy(ray.direction).applyMatrix3(axes.setFromMatrix4(fromWorld))
  const metersPerUnit = direction.length()
  direction.divideScalar(metersPerUnit)
  const meters = distanceToGround(
    ground,
    origin,
    direction,
    near * metersPerUnit,
    far * metersPerUnit
  )
  if (meters === null) return
  subpoint.copy(origin).addScaledVector(direction, meters)
  figureOf(ground.atmosphere).footPoint(subpoint, subpoint)
  const distance = meters / metersPerUnit
  intersects.push({
    distance,
    point: ray.at(distance, new Vector3()),
    normal: groundNormal(ground, subpoint, new Vector3()),
    face: null,
    object: ground
  })
}
