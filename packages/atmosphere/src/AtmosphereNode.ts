import type { Camera } from 'three'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import type { Atmosphere } from './Atmosphere'
import { viewNodes, type ViewNodes } from './ViewNodes'

/** Base of nodes that look at an atmosphere: they see to it that what they read is up to date. */
export abstract class AtmosphereNode extends Node<'vec4'> {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  protected readonly view: ViewNodes

  /**
   * @param camera - Camera whose view it is; null for whichever renders.
   * @throws If the atmosphere is missing.
   */
  constructor(atmosphere: Atmosphere, camera: Camera | null = null) {
    super('vec4')
    if (!atmosphere?.isAtmosphere) {
      // The static type, not the constructor's name: minifiers keep it.
      const { type } = new.target as unknown as { type: string }
      throw new Error(`${type}: atmosphere must be an Atmosphere, got ${typeof atmosphere}`)
    }
    this.atmosphere = atmosphere
    this.view = viewNodes(atmosphere, camera)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  // Layers are part of the shader.
  override customCacheKey(): number {
    return this.atmosphere.layers.length
  }

  override updateBefore(frame: NodeFrame): undefined {
    const view = this.view.prepare(frame)
    if (view === undefined) return
    for (const layer of this.atmosphere.layers) layer.prepare?.(frame.renderer!, view)
  }

  // Apart from updateBefore, where a nested render (a mirror's) may still set another camera's values.
  override update(frame: NodeFrame): undefined {
    const view = this.view.update(frame)
    if (view === undefined) return
    for (const layer of this.atmosphere.layers) layer.update?.(view)
  }
}
