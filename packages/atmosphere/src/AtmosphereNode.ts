import type { Camera } from 'three'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import type { Atmosphere } from './Atmosphere'
import { checkAtmosphere, viewNodes, type ViewNodes } from './ViewNodes'

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
    // The static type, not the constructor's name: minifiers keep it.
    checkAtmosphere((new.target as unknown as { type: string }).type, atmosphere)
    this.atmosphere = atmosphere
    this.view = viewNodes(atmosphere, camera)
    this.updateBeforeType = NodeUpdateType.RENDER
    this.updateType = NodeUpdateType.RENDER
  }

  override updateBefore(frame: NodeFrame): undefined {
    this.view.prepare(frame)
  }

  // Apart from updateBefore, where a nested render (a mirror's) may still set another camera's values.
  override update(frame: NodeFrame): undefined {
    this.view.update(frame)
  }
}
