import { fail } from '@welkin/geo'
import { Fn, If, mat3, output, positionView, vec3, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { AtmosphereNode } from '../view/AtmosphereNode'
import { aerialPerspectiveTo, type AerialPerspective } from './tsl/aerialPerspective'
import type { Mat3, Vec3 } from '../tsl-types'
import { covered, coveredPosition } from '../view/tsl/coveredPosition'

/** Distance up to which a material with `airAtVertices` takes the air of its vertices [m]. */
const FAR = 3e4

/** Material whose triangles are small beside their distance everywhere, such as a terrain's. */
export interface FineMaterial {
  /** True to find the clear air's effect at vertices within 30 km, in place of at every pixel. */
  readonly airAtVertices?: boolean
}

/**
 * Aerial perspective as a scene's fog: every material with `fog`, opaque or transparent, dims and
 * gains the light scattered between it and the camera.
 *
 * ```ts
 * scene.fogNode = aerialPerspectiveFog(atmosphere)
 * ```
 */
export class AerialPerspectiveFogNode extends AtmosphereNode {
  static get type(): string {
    return 'AerialPerspectiveFogNode'
  }

  /** Asked by three of what is in `scene.fog` alone. @throws Always: a node does not belong there. */
  get isFogExp2(): boolean {
    return fail('aerialPerspectiveFog', 'set it as scene.fogNode, not as scene.fog')
  }

  override setup(_builder: NodeBuilder): Node {
    return Fn(({ material }: NodeBuilder) => {
      const { transmittance, inScatter } =
        (material as FineMaterial).airAtVertices === true && this.layers.length === 0
          ? this.#ofVertices()
          : aerialPerspectiveTo(this.view, coveredPosition())
      return vec4(output.rgb.mul(transmittance).add(inScatter), output.a)
    })()
  }

  /** Clear air up to a fragment: of the vertices about it if it is near. */
  #ofVertices(): AerialPerspective {
    const { view } = this
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
}

/** Aerial perspective as a scene's fog: see {@link AerialPerspectiveFogNode}. */
export const aerialPerspectiveFog = (atmosphere: Atmosphere): AerialPerspectiveFogNode =>
  new AerialPerspectiveFogNode(atmosphere)
