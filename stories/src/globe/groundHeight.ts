import { Ellipsoid } from '@welkin/geo'
import { Raycaster, Vector3 } from 'three'
import type { Object3D } from 'three'

/** Height above the ellipsoid that no land has [m]. */
const CEILING = 10_000

/**
 * Height of the land below a place, above the ellipsoid [m]; NaN where no tile is loaded.
 *
 * @param terrain - Land with trees on it: its lowest surface counts.
 * @param surface - Land where there is no terrain.
 */
export function groundHeight(terrain: Object3D, surface: Object3D): (position: Vector3) => number {
  const raycaster = new Raycaster()
  const up = new Vector3()
  const { origin, direction } = raycaster.ray
  return position => {
    const height = Ellipsoid.WGS84.heightAt(position)
    Ellipsoid.WGS84.surfaceNormal(position, up)
    origin.copy(position).addScaledVector(up, Math.max(CEILING - height, 1))
    direction.copy(up).negate()
    const hit = raycaster.intersectObject(terrain).at(-1) ?? raycaster.intersectObject(surface)[0]
    return hit === undefined ? NaN : Ellipsoid.WGS84.heightAt(hit.point)
  }
}
