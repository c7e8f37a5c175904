import { vec4 } from 'three/tsl'
import { Node, NodeUpdateType, type NodeFrame } from 'three/webgpu'
import type { Vec4 } from '../tsl-types'

/** The part of `AutoExposureNode` that exposes colours. */
interface Exposure {
  seen(color: Vec4): Vec4
  updateBefore(frame: NodeFrame): undefined
}

/** A picture that is exposed as another one, which is metered: see `AutoExposureNode.exposed`. */
export class ExposedNode extends Node<'vec4'> {
  static get type(): string {
    return 'ExposedNode'
  }

  readonly #exposure: Exposure
  readonly colorNode: Node

  constructor(exposure: Exposure, colorNode: Node) {
    super('vec4')
    this.#exposure = exposure
    this.colorNode = colorNode
    this.updateBeforeType = NodeUpdateType.FRAME
  }

  override updateBefore(frame: NodeFrame): undefined {
    return this.#exposure.updateBefore(frame)
  }

  override setup(): Node {
    return this.#exposure.seen(vec4(this.colorNode as Vec4).toConst())
  }
}
