import { float, nodeObject, select as branch } from 'three/tsl'
import { Node } from 'three/webgpu'
import type { NodeBuilder } from 'three/webgpu'

/** A builder with what @types/three 0.187 lacks of it. */
type Builder = NodeBuilder & {
  getTypeLength(type: string): number
  getTernary(condition: string, ifTrue: string, ifFalse: string): string
  format(snippet: string, type: string, output?: string | null): string
}

class SelectNode extends Node {
  static get type(): string {
    return 'SelectNode'
  }

  constructor(
    readonly condition: Node<'bool'>,
    readonly ifTrue: Node,
    readonly ifFalse: Node
  ) {
    super()
  }

  /** That of the value with more components. */
  override getNodeType(builder: NodeBuilder): string {
    const [type, other] = [this.ifTrue, this.ifFalse].map(each => each.getNodeType(builder))
    const lengthOf = (each: string): number => (builder as Builder).getTypeLength(each)
    return lengthOf(other) > lengthOf(type) ? other : type
  }

  override generate(builder: NodeBuilder, output?: string | null): string {
    const type = this.getNodeType(builder)
    const condition = this.condition.build(builder, 'bool') as string
    const [ifTrue, ifFalse] = [this.ifTrue, this.ifFalse].map(
      each => each.build(builder, type) as string
    )
    const writer = builder as Builder
    const chosen = writer.getTernary(condition, ifTrue, ifFalse)
    return writer.format(`( ${chosen} )`, type, output)
  }
}

const toNode = (value: Node | number): Node => (typeof value === 'number' ? float(value) : value)

/**
 * One of two values by a condition, as an expression that computes both.
 *
 * TSL's own `select` is a branch, and each branch in a loop doubles the number of paths through it: software renderers follow
 * all of them and take minutes to compile the march of a storm. Where one of the values is costly, use `If`.
 */
export const select = ((condition: Node<'bool'>, ifTrue: Node | number, ifFalse: Node | number) =>
  nodeObject(
    new SelectNode(condition, toNode(ifTrue), toNode(ifFalse))
  )) as unknown as typeof branch
