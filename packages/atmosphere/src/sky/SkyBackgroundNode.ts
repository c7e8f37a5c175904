import { checkBoolean, checkOptions, fail } from '@welkin/geo'
import { Fn, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { AtmosphereNode } from '../view/AtmosphereNode'
import { screenRay } from '../view/tsl/screenRay'
import { pixelAngle, skyColor } from './tsl/sky'
import type { Vec3 } from '../tsl-types'

/** Options of {@link SkyBackgroundNode}. */
export interface SkyBackgroundOptions {
  /** Draws the sun's disc; by default true. */
  showSun?: boolean
}

/**
 * The sky as a scene's background: sky, sun and, below the horizon, the model's Lambertian ground.
 *
 * ```ts
 * scene.backgroundNode = skyBackground(atmosphere)
 * ```
 *
 * Works for every camera, perspective or orthographic, and for cube cameras.
 */
export class SkyBackgroundNode extends AtmosphereNode {
  static get type(): string {
    return 'SkyBackgroundNode'
  }

  /** See {@link SkyBackgroundOptions}. */
  readonly showSun: boolean

  /** @throws If the atmosphere is missing, or an option is unknown or of the wrong kind. */
  constructor(atmosphere: Atmosphere, options: SkyBackgroundOptions = {}) {
    super(atmosphere)
    const { showSun = true } = checkOptions('SkyBackgroundNode', options, 'showSun')
    checkBoolean('SkyBackgroundNode', 'showSun', showSun)
    this.showSun = showSun
  }

  /** Asked by three of what is in `scene.background` alone. @throws Always: a node does not belong there. */
  get isCubeTexture(): boolean {
    return fail('skyBackground', 'set it as scene.backgroundNode')
  }

  override customCacheKey(): number {
    return 2 * super.customCacheKey() + (this.showSun ? 1 : 0)
  }

  override setup(_builder: NodeBuilder): Node {
    return Fn(() => {
      const direction = this.view.toMapped(screenRay().direction).normalize().toConst() as Vec3
      return vec4(skyColor(this.view, direction, this.showSun ? pixelAngle(direction) : null), 1)
    })()
  }
}

/** The sky as a scene's background: see {@link SkyBackgroundNode}. */
export const skyBackground = (
  atmosphere: Atmosphere,
  options?: SkyBackgroundOptions
): SkyBackgroundNode => new SkyBackgroundNode(atmosphere, options)
