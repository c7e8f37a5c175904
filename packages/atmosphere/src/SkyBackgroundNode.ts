import { Fn, cameraProjectionMatrixInverse, screenUV, select, vec2, vec3, vec4 } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Atmosphere } from './Atmosphere'
import { AtmosphereNode } from './AtmosphereNode'
import { pixelAngle, skyColor } from './tsl/sky'
import type { Mat4, Vec3 } from './tsl-types'

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

  /** Whether the sun's disc is drawn. Set it before the first render. */
  showSun = true

  override customCacheKey(): number {
    return 2 * super.customCacheKey() + (this.showSun ? 1 : 0)
  }

  override setup(_builder: NodeBuilder): Node {
    return Fn(() => {
      const ray = screenRay().toConst() as Vec3
      return vec4(skyColor(this.view, ray, this.showSun ? pixelAngle(ray) : null), 1)
    })()
  }
}

/** Direction in view space of the fragment's line of sight. */
function screenRay(): Vec3 {
  const inverse = cameraProjectionMatrixInverse as unknown as Mat4
  const ndc = vec2(screenUV.x, screenUV.y.oneMinus()).mul(2).sub(1)
  // Depth cancels for a perspective camera: only the ratio of x, y to −z counts.
  const perspective = vec3(inverse.mul(vec4(ndc, 0.5, 1)).xyz)
  // Not the last element: a perspective camera's is 1 as well if its near plane is at 1.
  const isOrthographic = inverse.element(2).element(3).equal(0)
  const direction = perspective.mul(perspective.z.lessThan(0).select(1, -1))
  return select(isOrthographic, vec3(0, 0, -1), direction)
}

/** The sky as a scene's background: see {@link SkyBackgroundNode}. */
export const skyBackground = (atmosphere: Atmosphere): SkyBackgroundNode =>
  new SkyBackgroundNode(atmosphere)
