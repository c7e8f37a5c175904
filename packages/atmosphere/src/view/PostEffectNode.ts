import { fail } from '@welkin/geo'
import type { Camera } from 'three'
import { uniform } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { Atmosphere } from '../Atmosphere'
import { checkCamera } from '../check'
import { AtmosphereNode } from './AtmosphereNode'

/** Base of post effects: they take what was drawn, its depth and the camera that drew it. */
export abstract class PostEffectNode extends AtmosphereNode {
  /** Colour that was drawn, linear. */
  colorNode: Node
  /** Its depth, as the renderer writes it. */
  depthNode: Node
  /** The camera that drew it. */
  readonly camera: Camera
  /** Inverse of the camera's projection matrix; three's cache keys leave out what begins with _. */
  protected readonly _projectionInverse

  /** @throws If an argument is missing or of the wrong kind. */
  constructor(colorNode: Node, depthNode: Node, camera: Camera, atmosphere: Atmosphere) {
    const where = (new.target as unknown as { type: string }).type
    checkCamera(where, camera)
    super(atmosphere, camera)
    if (!colorNode?.isNode) fail(where, 'colorNode must be a node', colorNode)
    if (!depthNode?.isNode) fail(where, 'depthNode must be a node', depthNode)
    this.colorNode = colorNode
    this.depthNode = depthNode
    this.camera = camera
    this._projectionInverse = uniform(camera.projectionMatrixInverse)
  }
}
