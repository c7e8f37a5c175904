import { Fn, If, mat3, positionView, vec3 } from 'three/tsl'
import type { Mat3, Vec3 } from '../../tsl-types'
import { covered, coveredPosition } from '../../view/tsl/coveredPosition'
import type { ViewNodes } from '../../view/ViewNodes'

/**
 * Distance up to which air is found at vertices, over the viewer's height [–], and its bounds [m]. Beyond, pixels find their own: near the
 * horizon a triangle is seen along hundreds of kilometres, and from far away triangles bend with the planet.
 */
const FAR = { height: 2.5, least: 2e5, most: 1e6 }

/**
 * Light that changes over kilometres, at a fragment: of the vertices about it if it is near. So a material that gives this as its `airAtVertices`
 * has clear air of `aerialPerspectiveFog`, and sunlight. Within 1 % where triangles are small beside their distance.
 *
 * @param count - Number of its colours, 1 or 2.
 * @param lightAt - Colours at a position in view space.
 * @returns Null where there are sky layers, such as fog, which change too fast.
 */
export function airAtVertices(
  view: ViewNodes,
  count: number,
  lightAt: (position: Vec3) => readonly Vec3[]
): readonly Vec3[] | null {
  if (view.atmosphere.layers.length > 0) return null
  const near = Fn(() => {
    const [first, second = vec3(0)] = lightAt(positionView)
    return mat3(first, second, vec3(0))
  })() as unknown as Mat3 & { element(column: number): Vec3 }
  const position = coveredPosition()
  const far = view.height.mul(FAR.height).clamp(FAR.least, FAR.most)
  const light = [0, 1]
    .slice(0, count)
    .map(n => covered(near.element(n)).toVar() as unknown as Vec3 & { assign(value: Vec3): void })
  If(view.toMapped(position).length().greaterThan(far), () => {
    lightAt(position).forEach((own, n) => light[n].assign(own))
  })
  return light
}
