import type { Camera } from 'three'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import type { SkyLayer } from './SkyLayer'
import { checkAtmosphere, viewNodes, type ViewNodes } from './ViewNodes'

/**
 * Base of nodes that read an atmosphere, which is brought up to date before they are drawn. Extend it
 * for shaders of your own; `view` has the uniforms and tables.
 *
 * ```ts
 * // Light scattered between the camera and a fragment, by marching instead of the sky volume.
 * class MarchedHazeNode extends AtmosphereNode {
 *   static get type() { return 'MarchedHazeNode' }
 *
 *   setup() {
 *     return Fn(() => {
 *       const { air, viewpoint, up, lightDirection } = this.view
 *       const offset = this.view.toMapped(positionView).toConst()
 *       const distance = offset.length().toConst()
 *       const direction = offset.div(distance).toConst()
 *       const ray = {
 *         altitude: viewpoint.altitude, // in the air; `marchedAir` takes viewpoints anywhere
 *         cosView: direction.dot(up),
 *         cosLight: viewpoint.cosLight,
 *         cosViewLight: direction.dot(lightDirection)
 *       }
 *       const rise = pointAlong(air, ray, distance).altitude.sub(ray.altitude)
 *       const light = scattering(air, ray, distance, rise, 12)
 *       const radiance = scatteredRadiance(air.uniforms, light, ray.cosViewLight)
 *       return vec4(linearSRGB(air.uniforms, radiance), 1)
 *     })()
 *   }
 * }
 * ```
 */
export abstract class AtmosphereNode extends Node<'vec4'> {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Uniforms and tables for shaders, as the camera that renders sees them. */
  protected readonly view: ViewNodes
  #layersVersion = 0

  /**
   * @param camera - Camera whose view it is; null for whichever renders.
   * @throws If the atmosphere is missing.
   */
  constructor(atmosphere: Atmosphere, camera: Camera | null = null) {
    super('vec4')
    // The static type, not the constructor's name: minifiers keep it.
    checkAtmosphere((new.target as unknown as { type: string }).type, atmosphere)
    this.atmosphere = atmosphere
    this.view = viewNodes(atmosphere, camera)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  /** Layers of the sky that it draws. */
  protected get layers(): readonly SkyLayer[] {
    return this.atmosphere.layers
  }

  // Layers are part of the shader; the id tells a scene that one sky has taken another's place.
  override customCacheKey(): number {
    return 1024 * super.customCacheKey() + (this.atmosphere.layersVersion % 1024)
  }

  // three keeps a node's key until the node's version changes.
  override getCacheKey(force?: boolean, ignores?: Set<Node>): number {
    const { layersVersion } = this.atmosphere
    if (this.#layersVersion !== layersVersion) this.needsUpdate = true
    this.#layersVersion = layersVersion
    return super.getCacheKey(force, ignores)
  }

  override updateBefore(frame: NodeFrame): undefined {
    const view = this.view.prepare(frame)
    if (view === undefined) return
    for (const layer of this.layers) layer.prepare?.(frame.renderer!, view, frame)
  }

  // Apart from updateBefore, where a nested render (a mirror's) may still set another camera's values.
  override update(frame: NodeFrame): undefined {
    const view = this.view.update(frame)
    if (view === undefined) return
    for (const layer of this.layers) layer.update?.(view)
  }
}
