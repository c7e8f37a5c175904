import { fail } from '@welkin/geo'
import { Fn, output, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { AtmosphereNode } from '../view/AtmosphereNode'
import { coveredPosition } from '../view/tsl/coveredPosition'
import { aerialPerspectiveTo } from './tsl/aerialPerspective'
import type { airAtVertices } from './tsl/airAtVertices'

/** Material whose triangles are small beside their distance everywhere, such as a terrain's. */
export interface FineMaterial {
  /** `airAtVertices` has the effect of clear air found at vertices, not pixels, within 200 to 1,000 km by the viewer's height. */
  readonly airAtVertices?: typeof airAtVertices
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
    return fail('aerialPerspectiveFog', 'set it as scene.fogNode')
  }

  override setup(_builder: NodeBuilder): Node {
    return Fn(({ material }: NodeBuilder) => {
      const { transmittance, inScatter } =
        (material as FineMaterial).airAtVertices?.(this.view) ??
        aerialPerspectiveTo(this.view, coveredPosition())
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
