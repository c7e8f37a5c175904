import type { Camera, Matrix4, OrthographicCamera } from 'three'
import {
  float,
  getViewPosition,
  isBackgroundDepth,
  logarithmicDepthToViewZ,
  reference,
  uniform,
  vec3
} from 'three/tsl'
import type { Node, Renderer, TextureNode, UniformNode } from 'three/webgpu'
import type { Bool, Float, Vec2, Vec3 } from '../tsl-types'
import { getOrMake } from './getOrMake'

/** Inverse of a camera's projection, one for all that read it: compilers take what they compute with it for the same. */
const inverses = new WeakMap<Camera, UniformNode<'mat4', Matrix4>>()

/** Positions in view space of what a camera has drawn, by its depth. */
export class DepthRays {
  readonly #projectionInverse

  /** @param depthNode - Depth as the renderer writes it: a texture's node, or one for all pixels. */
  constructor(
    readonly depthNode: Node,
    readonly camera: Camera
  ) {
    this.#projectionInverse = getOrMake(inverses, camera, () =>
      uniform(camera.projectionMatrixInverse)
    )
  }

  depthAt(at: Vec2): Float {
    const depth = this.depthNode as unknown as TextureNode
    const read =
      typeof depth.sample === 'function'
        ? (depth.sample(at) as unknown as { level(n: number): Node }).level(0)
        : depth
    return float((read as unknown as { r: Float }).r).toConst()
  }

  /** Position of what is seen; for the sky any in its direction. In view space [world units]. */
  at(renderer: Renderer, at: Vec2): { position: Vec3; isSky: Bool } {
    const depth = this.depthAt(at)
    const isSky = isBackgroundDepth(depth).toConst() as Bool
    const { isOrthographicCamera } = this.camera as OrthographicCamera
    // Both, as nodes that draw air compute them: compilers take them for the same.
    const [ahead, drawn] = [float(0.5), depth].map(each => this.position(renderer, at, each))
    const ray = isOrthographicCamera ? (vec3(0, 0, -1) as unknown as Vec3) : ahead
    return { position: isSky.select(ray, drawn).toConst(), isSky }
  }

  /** Position of a depth at a place of the picture, in view space [world units]. */
  position(renderer: Renderer, at: Vec2, depth: Float): Vec3 {
    const { logarithmicDepthBuffer } = renderer as Renderer & { logarithmicDepthBuffer: boolean }
    const { isOrthographicCamera } = this.camera as OrthographicCamera
    if (!logarithmicDepthBuffer || isOrthographicCamera) {
      return getViewPosition(at, depth, this.#projectionInverse).toConst()
    }
    const middle = getViewPosition(at, float(0.5), this.#projectionInverse).toConst() as Vec3
    const [near, far] = ['near', 'far'].map(name => reference(name, 'float', this.camera) as Float)
    const z = logarithmicDepthToViewZ(depth, near, far)
    return middle.mul(z.div(middle.z)).toConst()
  }
}
