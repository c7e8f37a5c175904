import { Fn, If, mat3, positionView, vec3 } from 'three/tsl'
import type { Mat3, Vec3 } from '../../tsl-types'
import { covered, coveredPosition } from '../../view/tsl/coveredPosition'
import type { ViewNodes } from '../../view/ViewNodes'
import { aerialPerspectiveTo, type AerialPerspective } from './aerialPerspective'

/** Distance up to which the air of vertices is taken [m]. */
const FAR = 3e4

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
  If(view.toMapped(position).length().greaterThan(FAR), () => {
    const far = aerialPerspectiveTo(view, position)
    transmittance.assign(far.transmittance)
    inScatter.assign(far.inScatter)
  })
  return { transmittance, inScatter }
}
