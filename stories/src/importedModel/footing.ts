import { Raycaster, Vector3 } from 'three'
import type { Mesh } from 'three'

/** Height from which one looks down for what stands at a place [m]. */
const CEILING = 100

/** Distance that one keeps from walls [m]. */
const BODY = 0.4

const AROUND = [
  [0, 0],
  [-BODY, -BODY],
  [-BODY, BODY],
  [BODY, -BODY],
  [BODY, BODY]
] as const

/** Height of the highest surface of meshes at a place and about it: for walks, in a world whose ground is at 0 [m]. */
export function footingOn(meshes: readonly Mesh[]): (place: Vector3) => number {
  const raycaster = new Raycaster(new Vector3(), new Vector3(0, -1, 0))
  return ({ x, z }) => {
    let highest = 0
    for (const [dx, dz] of AROUND) {
      raycaster.ray.origin.set(x + dx, CEILING, z + dz)
      const hit = raycaster.intersectObjects([...meshes], false).at(0)
      if (hit !== undefined) highest = Math.max(highest, hit.point.y)
    }
    return highest
  }
}
