import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { HalfFloatType, type TextureDataType, Vector2 } from 'three'
import { uv } from 'three/tsl'
import { NodeUpdateType, TextureNode } from 'three/webgpu'
import type { Node, NodeFrame } from 'three/webgpu'

const _size = new Vector2()

/**
 * A picture that is drawn to a texture once a frame, as by three's `rtt`, but not cleared before: every pixel is drawn, and to
 * clear them costs as much as a third of a millisecond.
 */
export class PictureNode extends TextureNode {
  static get type(): string {
    return 'PictureNode'
  }

  /** Pixels along a side over those of the canvas, in ]0, 1]. */
  scale = 1
  readonly #target
  readonly #pass: FragmentPass

  /**
   * @param name - Name of the pass.
   * @param picture - Its pixels.
   * @param type - Type of their numbers; bytes are enough for colours of the display, and are read in half the time.
   */
  constructor(name: string, picture: Node<'vec4'>, type: TextureDataType = HalfFloatType) {
    const target = tableTarget(name, 1, 1)
    target.texture.type = type
    super(target.texture, uv())
    this.#target = target
    this.#pass = new FragmentPass(name, picture)
    this.updateMatrix = false
    this.updateBeforeType = NodeUpdateType.FRAME
  }

  override updateBefore({ renderer }: NodeFrame): undefined {
    if (renderer === null) return
    const { x, y } = renderer.getDrawingBufferSize(_size)
    this.#target.setSize(Math.floor(x * this.scale), Math.floor(y * this.scale))
    this.#pass.render(renderer, this.#target)
  }

  // What reads it elsewhere is a texture, whose picture this one draws.
  override clone(): this {
    const reading = new TextureNode(this.value, this.uvNode, this.levelNode)
    reading.referenceNode = this
    return reading as this
  }

  override dispose(): void {
    this.#target.dispose()
    this.#pass.dispose()
    super.dispose()
  }
}
