import type { OrthographicCamera, PerspectiveCamera } from 'three'
import {
  float,
  getViewPosition,
  isBackgroundDepth,
  logarithmicDepthToViewZ,
  uniform,
  vec3
} from 'three/tsl'
import type { Node, Renderer, TextureNode } from 'three/webgpu'
import { number } from '../../uniforms'
import type { Bool, Float, Vec2, Vec3 } from '../../tsl-types'

/** Distance that stands for the sky [world units]. */
const SKY = 1e10

/** Positions in view space of what a camera has drawn, by its depth. */
export class DepthRays {
  readonly #projectionInverse
  readonly #near = number()
  readonly #far = number()

  /** @param depthNode - Depth as the renderer writes it: a texture's node, or one for all pixels. */
  constructor(
    readonly depthNode: Node,
    readonly camera: PerspectiveCamera | OrthographicCamera
  ) {
    this.#projectionInverse = uniform(camera.projectionMatrixInverse)
  }

  /** Follows the camera. */
  update(): void {
    this.#near.value = this.camera.near
    this.#far.value = this.camera.far
  }

  depthAt(at: Vec2): Float {
    const depth = this.depthNode as unknown as TextureNode
    const read =
      typeof depth.sample === 'function'
        ? (depth.sample(at) as unknown as { level(n: number): Node }).level(0)
        : depth
    return float((read as unknown as { r: Float }).r).toConst()
  }

  /** Distance before the camera of what is seen; very far for the sky [world units]. */
  viewDepth(renderer: Renderer, at: Vec2): Float {
    const depth = this.depthAt(at)
    const z = this.#position(renderer, at, depth).z.negate()
    return (isBackgroundDepth(depth) as Bool).select(SKY, z).toConst()
  }

  /**
   * Direction of view and position of what is seen; very far for the sky. In view space [world units].
   */
  at(renderer: Renderer, at: Vec2): { direction: Vec3; position: Vec3; isSky: Bool } {
    const depth = this.depthAt(at)
    const isSky = (isBackgroundDepth(depth) as Bool).toConst() as Bool
    const { isOrthographicCamera } = this.camera as OrthographicCamera
    const direction = (
      isOrthographicCamera
        ? vec3(0, 0, -1)
        : getViewPosition(at, float(0.5), this.#projectionInverse).normalize()
    ) as Vec3
    return { direction: direction.toConst(), position: this.#position(renderer, at, depth), isSky }
  }

  #position(renderer: Renderer, at: Vec2, depth: Float): Vec3 {
    const { logarithmicDepthBuffer } = renderer as Renderer & { logarithmicDepthBuffer: boolean }
    const { isOrthographicCamera } = this.camera as OrthographicCamera
    if (!logarithmicDepthBuffer || isOrthographicCamera) {
      return getViewPosition(at, depth, this.#projectionInverse).toConst()
    }
    const middle = getViewPosition(at, float(0.5), this.#projectionInverse).toConst() as Vec3
    const z = logarithmicDepthToViewZ(depth, this.#near, this.#far)
    return middle.mul(z.div(middle.z)).toConst()
  }
}
