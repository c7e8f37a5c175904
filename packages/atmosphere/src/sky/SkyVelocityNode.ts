import { fail } from '@welkin/geo'
import { Matrix3, Matrix4 } from 'three'
import type { Camera, OrthographicCamera } from 'three'
import { Fn, If, isBackgroundDepth, renderGroup, uniform, uv, vec3, vec4 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import { checkCamera } from '../check'
import { unjitteredProjection } from '../view/cpu/unjittered'
import type { Float, Mat3, Vec2, Vec3, Vec4 } from '../tsl-types'

const _projection = new Matrix4()
const _view = new Matrix4()
const _now = new Matrix3()

/**
 * Velocities of a picture with a sky: three's where something was drawn, and elsewhere those of the sky, which is infinitely
 * far and moves as the camera turns.
 *
 * ```ts
 * scenePass.setMRT(mrt({ output, velocity }))
 * const motion = skyVelocity(scenePass.getTextureNode('velocity'), depth, camera)
 * pipeline.outputNode = traa(picture, depth, convertToTexture(motion), camera)
 * ```
 *
 * Without them stars, moon and sun leave trails under `traa`, and do not blur under `motionBlur`. For perspective cameras
 * alone: an orthographic one sees a sky without directions.
 */
export class SkyVelocityNode extends Node<'vec4'> {
  static get type(): string {
    return 'SkyVelocityNode'
  }

  /** Velocities of what was drawn, as three's `velocity` has them: normalized device coordinates a frame. */
  velocityNode: Node
  /** Depth of the picture, as the renderer writes it. */
  depthNode: Node
  readonly camera: Camera
  /** Normalized device coordinates (x, y, 1) to the last frame's clip space (x, y, w), of directions. */
  readonly #toPrevious = uniform(new Matrix3()).setGroup(renderGroup)
  /** Directions in world space to the clip space of the last frame. */
  readonly #previous = new Matrix3()
  #isFirst = true

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(velocityNode: Node, depthNode: Node, camera: Camera) {
    super('vec4')
    if (!velocityNode?.isNode) fail('SkyVelocityNode', 'velocityNode must be a node', velocityNode)
    if (!depthNode?.isNode) fail('SkyVelocityNode', 'depthNode must be a node', depthNode)
    checkCamera('SkyVelocityNode', camera)
    if ((camera as OrthographicCamera).isOrthographicCamera)
      fail('SkyVelocityNode', 'camera must be a perspective camera', camera)
    this.velocityNode = velocityNode
    this.depthNode = depthNode
    this.camera = camera
    this.updateBeforeType = NodeUpdateType.FRAME
  }

  override updateBefore(): undefined {
    const { matrixWorld } = this.camera
    unjitteredProjection(this.camera, _projection)
    // Rows x, y and w: directions have no translation.
    _view.copy(matrixWorld).setPosition(0, 0, 0).invert()
    const { elements: p } = _projection.multiply(_view)
    _now.set(p[0], p[4], p[8], p[1], p[5], p[9], p[3], p[7], p[11])
    if (this.#isFirst) this.#previous.copy(_now)
    this.#isFirst = false
    this.#toPrevious.value.copy(_now).invert().premultiply(this.#previous)
    this.#previous.copy(_now)
  }

  override setup(): Node {
    return Fn(() => {
      const velocity = vec4(this.velocityNode as Vec4).toVar() as Vec4
      If(isBackgroundDepth((this.depthNode as unknown as { r: Float }).r), () => {
        const at = uv() as unknown as Vec2
        const ndc = vec3(at.x.mul(2).sub(1), at.y.mul(-2).add(1), 1).toConst() as Vec3
        const before = (this.#toPrevious as unknown as Mat3).mul(ndc).toConst() as Vec3
        velocity.assign(vec4(ndc.xy.sub(before.xy.div(before.z.max(1e-6))), 0, 1))
      })
      return velocity
    })()
  }
}

/** Velocities of a picture with a sky: see {@link SkyVelocityNode}. */
export const skyVelocity = (velocity: Node, depth: Node, camera: Camera): SkyVelocityNode =>
  new SkyVelocityNode(velocity, depth, camera)
