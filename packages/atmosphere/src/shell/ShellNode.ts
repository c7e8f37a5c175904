import type { Camera } from 'three'
import { Node, NodeUpdateType } from 'three/webgpu'
import type { NodeFrame } from 'three/webgpu'
import type { Vec4 } from '../tsl-types'

type ShellRenderer = NonNullable<NodeFrame['renderer']>

/** Part of a shell that its node calls before the shell is drawn. */
interface DrawnShell {
  bake(renderer: ShellRenderer): void
  update(renderer: ShellRenderer, camera: Camera, frame: NodeFrame): void
}

/** Colour of a shell; bakes tables and updates uniforms whenever the shell is drawn. */
export class ShellNode extends Node<'vec4'> {
  static get type(): string {
    return 'AtmosphereShellNode'
  }

  readonly #shell: DrawnShell
  readonly #output: Vec4

  constructor(shell: DrawnShell, output: Vec4) {
    super('vec4')
    this.#shell = shell
    this.#output = output
    this.updateBeforeType = NodeUpdateType.OBJECT
  }

  override updateBefore(frame: NodeFrame): undefined {
    const { renderer, camera } = frame
    if (renderer === null) return
    this.#shell.bake(renderer)
    if (camera !== null) this.#shell.update(renderer, camera, frame)
  }

  override setup(): Node {
    return this.#output
  }
}
