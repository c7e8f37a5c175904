import { fail } from '@welkin/geo'
import { Fn, output, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { AtmosphereNode } from '../view/AtmosphereNode'
import { aerialPerspectiveTo } from './tsl/aerialPerspective'
import { lightAtFragment } from './tsl/lightAtFragment'

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
    return fail('aerialPerspectiveFog', 'set it as scene.fogNode')
  }

  override setup(_builder: NodeBuilder): Node {
    return Fn(({ material }: NodeBuilder) => {
      const [transmittance, inScatter] = lightAtFragment(material, this.view, 2, position =>
        Object.values(aerialPerspectiveTo(this.view, position))
      )
      return vec4(output.rgb.mul(transmittance).add(inScatter), output.a)
    })()
  }
}

/**
 * Aerial perspective as a scene's fog: see {@link AerialPerspectiveFogNode}.
 *
 * @param options - None: light shafts of materials are a layer of the sky, `forwardShafts`.
 */
export const aerialPerspectiveFog = (
  atmosphere: Atmosphere,
  options?: undefined
): AerialPerspectiveFogNode =>
  options
    ? fail('aerialPerspectiveFog', 'use forwardShafts()')
    : new AerialPerspectiveFogNode(atmosphere)
