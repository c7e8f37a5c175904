import { Fn, mat3, vec3 } from 'three/tsl'
import type { Mat3, Vec3 } from '../../tsl-types'
import type { ViewNodes } from '../../view/ViewNodes'
import { aerialPerspectiveTo, type AerialPerspective } from './aerialPerspective'
import { foundAtVertices } from './foundAtVertices'

/**
 * Clear air up to a fragment: of the vertices about it if it is near, as a material has it that gives this as its
 * `airAtVertices` to `aerialPerspectiveFog`. Within 0.6 % where triangles are small beside their distance.
 *
 * @returns Null where there are sky layers, such as fog, which change too fast.
 */
export function airAtVertices(view: ViewNodes): AerialPerspective | null {
  if (view.atmosphere.layers.length > 0) return null
  const [transmittance, inScatter] = foundAtVertices(view, position => {
    const found = Fn(() => {
      const { transmittance, inScatter } = aerialPerspectiveTo(view, position)
      return mat3(transmittance, inScatter, vec3(0))
    })() as unknown as Mat3 & { element(column: number): Vec3 }
    return [found.element(0), found.element(1)]
  })
  return { transmittance, inScatter }
}
