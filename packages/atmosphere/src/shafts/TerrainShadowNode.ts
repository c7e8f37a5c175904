import { Matrix4, Vector3 } from 'three'
import { positionView, renderGroup, uniform, vec4 } from 'three/tsl'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import { fail } from '@welkin/geo'
import type { Float, Mat4 } from '../tsl-types'
import { HeightFieldShadow } from './HeightFieldShadow'
import type { ParallelLight } from './shadowMaps'
import { SweptShadow } from './SweptShadow'

/** A light that comes from where it stands relative to its target, as three's `DirectionalLight`. */
export type TargetedLight = ParallelLight & {
  readonly target: { readonly matrixWorld: Matrix4 }
}

const _toLight = new Vector3()
const _target = new Vector3()

/**
 * Shadows of hills on surfaces, however far the hills are, by the map of their {@link HeightFieldShadow}: the part of
 * a light that passes, for the slot that three has for shadows of its own.
 *
 * ```ts
 * sun.castShadow = renderer.shadowMap.enabled = true
 * // With three's shadow map of the light; `terrainShadow(hills, sun)` is of hills alone.
 * Object.assign(sun.shadow, { shadowNode: terrainShadow(hills, sun, shadow(sun)) })
 * ```
 *
 * It falls on what has `receiveShadow`, the terrain too: ground that lies below the field, between its texels, is as lit as
 * the field there. Light shafts of the same light read the same map.
 */
export class TerrainShadowNode extends Node<'float'> {
  static get type(): string {
    return 'TerrainShadowNode'
  }

  /** Hills that cast the shadows; shared, not owned. */
  readonly hills: HeightFieldShadow
  /** Light that they take; shared, not owned. */
  readonly light: TargetedLight
  /** Another shadow node, to be multiplied with. */
  shadowNode: Node | null
  #swept: SweptShadow | null = null
  /** View space of the camera that renders [world units] to places and heights of the field. */
  readonly #toField = uniform(new Matrix4()).setGroup(renderGroup)

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(hills: HeightFieldShadow, light: TargetedLight, shadowNode: Node | null = null) {
    super('float')
    if (!(hills instanceof HeightFieldShadow))
      fail('TerrainShadowNode', 'hills must be a HeightFieldShadow', hills)
    if (!light?.target?.matrixWorld)
      fail('TerrainShadowNode', 'light must be a DirectionalLight', light)
    if (shadowNode !== null && !shadowNode.isNode)
      fail('TerrainShadowNode', 'shadowNode must be a node or null', shadowNode)
    this.hills = hills
    this.light = light
    this.shadowNode = shadowNode
    this.updateBeforeType = NodeUpdateType.RENDER
  }

  override updateBefore({ renderer, camera }: NodeFrame): undefined {
    if (renderer === null || camera === null) return
    const { matrixWorld, target } = this.light
    _toLight.setFromMatrixPosition(matrixWorld)
    _toLight.sub(_target.setFromMatrixPosition(target.matrixWorld)).normalize()
    const toField = this.#swept?.update(renderer, camera, _toLight)
    if (toField) this.#toField.value.multiplyMatrices(toField, camera.matrixWorld)
  }

  override setup(): Node {
    const place = (this.#toField as unknown as Mat4).mul(vec4(positionView, 1)).xyz.toConst()
    this.#swept ??= new SweptShadow(this.hills, this.light)
    const passing = this.#swept.transmittance(place, true)
    return this.shadowNode === null ? passing : passing.mul(this.shadowNode as Float)
  }

  /** Lets go of the map, which is freed if nothing else reads it. It can be used again. */
  override dispose(): void {
    this.#swept?.dispose()
    this.#swept = null
    super.dispose()
  }
}

/** Shadows of hills on surfaces: see {@link TerrainShadowNode}. */
export const terrainShadow = (
  hills: HeightFieldShadow,
  light: TargetedLight,
  shadowNode: Node | null = null
): TerrainShadowNode => new TerrainShadowNode(hills, light, shadowNode)
