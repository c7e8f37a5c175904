import { Vector3 } from 'three'
import { Fn, If, float, positionView, renderGroup, uniform } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame, UniformNode } from 'three/webgpu'
import { viewNodes } from '@welkin/atmosphere'
import type { AtmosphereView, ViewNodes } from '@welkin/atmosphere'
import type { CloudsNode } from './CloudsNode'
import { columnTowardsSun } from './tsl/columns'
import { sampleShadows } from './tsl/shadowMap'
import type { Float, Vec3 } from './tsl-types'

const position = (view: AtmosphereView, target: Vector3): Vector3 =>
  target.copy(view.up).multiplyScalar(view.atmosphere.parameters.bottomRadius + view.height)

/**
 * Shadows of clouds on surfaces: the part of the sunlight that passes, for the slot that three has for
 * shadows of its own.
 *
 * ```ts
 * const sun = new SunDirectionalLight(atmosphere)
 * sun.castShadow = renderer.shadowMap.enabled = true
 * // With three's shadow map of the light; `cloudShadow(cloudsNode)` is of clouds alone.
 * Object.assign(sun.shadow, { shadowNode: cloudShadow(cloudsNode, shadow(sun)) })
 * ```
 *
 * It falls on what has `receiveShadow`. Near the camera it is read from the clouds' shadow maps, which
 * are those of the frame before; farther away the weather says how much passes in the mean. Layers whose
 * `shadow` is false cast none. The clouds' node must be drawn, by any pipeline.
 */
export class CloudShadowNode extends Node<'float'> {
  static get type(): string {
    return 'CloudShadowNode'
  }

  /** Whose clouds; shared, not owned. */
  readonly clouds: CloudsNode
  /** Another shadow node, to be multiplied with. */
  shadowNode: Node | null
  /** Of the camera that renders. */
  readonly #view: ViewNodes
  /** From the clouds' camera, as their maps know it, to the one that renders [m]. */
  readonly #shift: UniformNode<'vec3', Vector3> = uniform(new Vector3()).setGroup(renderGroup)

  /** @throws If the clouds are missing. */
  constructor(clouds: CloudsNode, shadowNode: Node | null = null) {
    super('float')
    if (clouds?.shadows === undefined) {
      throw new Error(`CloudShadowNode: clouds must be a CloudsNode, got ${typeof clouds}`)
    }
    this.clouds = clouds
    this.shadowNode = shadowNode
    this.#view = viewNodes(clouds.atmosphere)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.#view.prepare(frame)
  }

  override update(frame: NodeFrame): undefined {
    const view = this.#view.update(frame)
    if (view !== undefined) position(view, this.#shift.value).sub(this.clouds.shadows.camera)
  }

  override setup(): Node {
    const { clouds } = this
    const { field, shadows } = clouds
    return Fn(() => {
      const offset = this.#view.toMapped(positionView).add(this.#shift).toConst() as Vec3
      const { shadow, known } = sampleShadows(shadows.nodes, offset, float(0))
      const depth = shadow.toVar()
      If(known.equal(0), () => {
        const distance = offset.length()
        depth.assign(columnTowardsSun(field, { offset, ...field.view.place(offset), distance }))
      })
      // What is scattered within the forward peak arrives with the sun.
      const passing = depth.mul(clouds.light.nodes.depthScale).negate().exp()
      return this.shadowNode === null ? passing : passing.mul(this.shadowNode as Float)
    })()
  }
}

/** Shadows of clouds on surfaces: see {@link CloudShadowNode}. */
export const cloudShadow = (clouds: CloudsNode, shadowNode: Node | null = null): CloudShadowNode =>
  new CloudShadowNode(clouds, shadowNode)
