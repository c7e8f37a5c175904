import { If, positionView } from 'three/tsl'
import type { Vec3, Vec4 } from '../../tsl-types'
import { covered, coveredPosition } from '../../view/tsl/coveredPosition'
import type { ViewNodes } from '../../view/ViewNodes'

/**
 * Distance up to which values are found at vertices, over the viewer's height [–], and its bounds [m]. Beyond, pixels find their own: near the
 * horizon a triangle is seen along hundreds of kilometres, and from far away triangles bend with the planet.
 */
const FAR = { height: 2.5, least: 2e5, most: 1e6 }

/**
 * Values at a fragment's place: those of the vertices about it if it is near.
 *
 * @param find - Values at a position in view space.
 */
export function foundAtVertices<T extends Vec3 | Vec4>(
  view: ViewNodes,
  find: (position: Vec3) => T[]
): T[] {
  const values = find(positionView as Vec3).map(
    value => covered(value).toVar() as unknown as T & { assign(value: T): void }
  )
  const position = coveredPosition()
  const far = view.height.mul(FAR.height).clamp(FAR.least, FAR.most)
  If(view.toMapped(position).length().greaterThan(far), () => {
    for (const [n, own] of find(position).entries()) values[n].assign(own)
  })
  return values
}
