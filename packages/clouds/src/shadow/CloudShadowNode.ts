import { Fn, If, float, positionView } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import { checkSource, viewNodes } from '@welkin/atmosphere'
import type { LightSource, ViewNodes } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { checkClouds } from '../check'
import { viewpointMapped } from '../density/CloudField'
import type { CloudsNode } from '../march/CloudsNode'
import { opticalDepthTowards } from '../density/tsl/columns'
import { sampleShadows } from './tsl/sampleShadows'
import type { Float, Vec3 } from '../tsl-types'
import { number, vector3 } from '../uniforms'

/**
 * Shadows of clouds on surfaces: the part of the sunlight, or of the moonlight, that passes, for the
 * slot that three has for shadows of its own.
 *
 * ```ts
 * const sun = new SunDirectionalLight(atmosphere)
 * sun.castShadow = renderer.shadowMap.enabled = true
 * // With three's shadow map of the light; `cloudShadow(cloudsNode)` is of clouds alone.
 * Object.assign(sun.shadow, { shadowNode: cloudShadow(cloudsNode, shadow(sun)) })
 * // By moonlight; `null` instead of `shadow(moonlight)` for clouds alone.
 * Object.assign(moonlight.shadow, {
 *   shadowNode: cloudShadow(cloudsNode, shadow(moonlight), moonlight.source)
 * })
 * ```
 *
 * It falls on what has `receiveShadow`. Near the camera it is read from the clouds' shadow maps, which
 * are those of the frame before and of the light that is up there, the sun's by day and the moon's by
 * night; elsewhere the weather says how much passes in the mean. Layers whose
 * `shadow` is false cast none. The clouds' node must be drawn, by any pipeline; after its `dispose` all light passes.
 */
export class CloudShadowNode extends Node<'float'> {
  static get type(): string {
    return 'CloudShadowNode'
  }

  /** Clouds that cast the shadows; shared, not owned. */
  readonly clouds: CloudsNode
  /** Another shadow node, to be multiplied with. */
  shadowNode: Node | null
  /** Source of the light that they take. */
  readonly source: LightSource
  /** View of the camera that renders. */
  readonly #view: ViewNodes
  /** Displacement from the clouds' camera, as their maps know it, to the one that renders [m]. */
  readonly #shift = vector3()

  /** 1 while the maps are of this source's light. */
  readonly #isMapped = number(1)

  /**
   * @param source - Source of the light that they take; left out, the sun.
   * @throws If the clouds are missing, or another argument is of the wrong kind.
   */
  constructor(
    clouds: CloudsNode,
    shadowNode: Node | null = null,
    source: LightSource = clouds?.atmosphere?.sun
  ) {
    super('float')
    checkClouds('CloudShadowNode', clouds)
    if (shadowNode !== null && !shadowNode.isNode) {
      fail('CloudShadowNode', 'shadowNode must be a node or null', shadowNode)
    }
    checkSource('CloudShadowNode', 'source', source)
    this.clouds = clouds
    this.shadowNode = shadowNode
    this.source = source
    this.#view = viewNodes(clouds.atmosphere, null, source)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.#view.prepare(frame)
  }

  override update(frame: NodeFrame): undefined {
    const view = this.#view.update(frame)
    const { shadows } = this.clouds
    this.#isMapped.value = shadows.source === this.source ? 1 : 0
    if (view !== undefined) viewpointMapped(view, this.#shift.value).sub(shadows.camera)
  }

  override setup(): Node {
    const { clouds } = this
    const { field, shadows } = clouds
    if (clouds.isDisposed) return this.shadowNode ?? float(1)
    return Fn(() => {
      const offset = this.#view.toMapped(positionView).add(this.#shift).toConst() as Vec3
      const { shadow, inMap } = sampleShadows(shadows.nodes, offset)
      const isMapped = inMap.mul(this.#isMapped).toConst()
      const depth = shadow.mul(this.#isMapped).toVar()
      If(isMapped.lessThan(1), () => {
        const distance = offset.length()
        const sample = { offset, ...field.view.localCoordinates(offset), distance }
        const mean = opticalDepthTowards(field, sample, this.#view.lightDirection)
        depth.addAssign(isMapped.oneMinus().mul(mean))
      })
      // What is scattered within the forward peak arrives with the sun.
      const passing = depth.mul(clouds.light.nodes.depthScale).negate().exp()
      return this.shadowNode === null ? passing : passing.mul(this.shadowNode as Float)
    })()
  }
}

/** Shadows of clouds on surfaces: see {@link CloudShadowNode}. */
export const cloudShadow = (
  clouds: CloudsNode,
  shadowNode: Node | null = null,
  source?: LightSource
): CloudShadowNode => new CloudShadowNode(clouds, shadowNode, source)
