import { Fn, If, mat3, positionView, vec3 } from 'three/tsl'
import type { Mat3, Vec3 } from '../../tsl-types'
import { covered, coveredPosition } from '../../view/tsl/coveredPosition'
import type { ViewNodes } from '../../view/ViewNodes'
import { aerialPerspectiveTo, type AerialPerspective } from './aerialPerspective'

/**
 * Distance up to which air is found at vertices, over the viewer's height [–], and its bounds [m]. Beyond, pixels find their own: near the
 * horizon a triangle is seen along hundreds of kilometres, and from far away triangles bend with the planet.
 */
const FAR = { height: 2.5, least: 2e5, most: 1e6 }

/**
 * Clear air up to a fragment: of the vertices about it if it is near, as a material has it that gives this as its
 * `airAtVertices` to `aerialPerspectiveFog`. Within 0.6 % where triangles are small beside their distance.
 *
 * @returns Null where there are sky layers, such as fog, which change too fast.
 */
export function airAtVertices(view: ViewNodes): AerialPerspective | null {
  if (view.atmosphere.layers.length > 0) return null
  const near = Fn(() => {
    const { transmittance, inScatter } = aerialPerspectiveTo(view, positionView)
    return mat3(transmittance, inScatter, vec3(0))
  })() as unknown as Mat3 & { element(column: number): Vec3 }
  const [transmittance, inScatter] = [0, 1].map(
    n => covered(near.element(n)).toVar() as unknown as Vec3 & { assign(value: Vec3): void }
  )
  const position = coveredPosition()
  const far = view.height.mul(FAR.height).clamp(FAR.least, FAR.most)
  If(view.toMapped(position).length().greaterThan(far), () => {
    const own = aerialPerspectiveTo(view, position)
    transmittance.assign(own.transmittance)
    inScatter.assign(own.inScatter)
  })
  return { transmittance, inScatter }
}
