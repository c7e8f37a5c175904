import { unjitteredProjection } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { Fn, If, exp2, int, uv, vec2, vec4 } from 'three/tsl'
import { Node } from 'three/webgpu'
import { checkClouds } from '../check'
import { jitteredProjection } from '../march/FrameUniforms'
import type { CloudsNode } from '../march/CloudsNode'
import { viewRayAt } from '../march/tsl/viewRay'
import type { Mat3, Vec2, Vec3, Vec4 } from '../tsl-types'
import { unpack } from './tsl/packing'

/** Transmittance of clouds below which the picture moves with them, not with what is behind them [–]. */
const OPAQUE = 0.5

/**
 * Velocities of a picture with clouds in it: theirs where they hide most of what is behind them, by their distance and
 * their wind, and the given ones elsewhere. From its construction until it is disposed, the clouds are drawn for their camera
 * without TRAA's jitter, which their history would take for a turn.
 *
 * ```ts
 * scenePass.setMRT(mrt({ output, velocity }))
 * const sky = skyVelocity(scenePass.getTextureNode('velocity'), depth, camera)
 * const motion = cloudVelocity(sky, cloudsNode)
 * pipeline.outputNode = traa(convertToTexture(cloudsNode), depth, convertToTexture(motion), camera)
 * ```
 */
export class CloudVelocityNode extends Node<'vec4'> {
  static get type(): string {
    return 'CloudVelocityNode'
  }

  /** Velocities without clouds, as three's `velocity` has them: normalized device coordinates a frame. */
  velocityNode: Node
  /** Shared, not owned. */
  readonly clouds: CloudsNode

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(velocityNode: Node, clouds: CloudsNode) {
    super('vec4')
    if (!velocityNode?.isNode) {
      fail('CloudVelocityNode', 'velocityNode must be a node', velocityNode)
    }
    checkClouds('CloudVelocityNode', clouds)
    this.velocityNode = velocityNode
    this.clouds = clouds
    clouds.passes.viewRays.frame.projectionOf = unjitteredProjection
  }

  override setup(): Node {
    const { passes } = this.clouds
    const { frame } = passes.viewRays
    return Fn(() => {
      const velocity = vec4(this.velocityNode as Vec4).toVar() as Vec4
      const at = uv() as unknown as Vec2
      const { a: transmittance } = passes.accumulated.light.sample(at).level(0).toConst()
      If(transmittance.lessThan(OPAQUE).and(frame.hasHistory.greaterThan(0)), () => {
        const { x: distance } = unpack(passes.accumulated.distances.sample(at).level(0))
        const { ndc, length } = viewRayAt(passes.viewRays, at)
        // The first layer's wind stands for all: others differ by millimetres to half a metre in a frame.
        const origin = frame.originArray.element(int(0)).xyz
        const before = (frame.raysBefore as unknown as Mat3)
          .mul(ndc)
          .add(origin.mul(length.div(exp2(distance))))
          .toConst() as Vec3
        const ndcBefore = before.xy.div(before.z.max(1e-9))
        velocity.assign(vec4(ndc.xy.sub(vec2(ndcBefore)), 0, 1))
      })
      return velocity
    })()
  }

  /** Lets the clouds follow their camera's jitter again; they stay with who made them. */
  override dispose(): void {
    this.clouds.passes.viewRays.frame.projectionOf = jitteredProjection
    super.dispose()
  }
}

/** Velocities of a picture with clouds in it: see {@link CloudVelocityNode}. */
export const cloudVelocity = (velocity: Node, clouds: CloudsNode): CloudVelocityNode =>
  new CloudVelocityNode(velocity, clouds)
