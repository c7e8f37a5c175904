import { nodeObject, select as branch, uniformFlow } from 'three/tsl'
import { Node, type NodeBuilder } from 'three/webgpu'

/** An expression in parentheses: three's GLSL has none about `?:`, which binds the least of all operators. */
class ParenthesesNode extends Node {
  constructor(readonly node: Node) {
    super()
  }

  override getNodeType(builder: NodeBuilder): string {
    return this.node.getNodeType(builder)
  }

  override generate(builder: NodeBuilder): string {
    return `( ${this.node.build(builder) as string} )`
  }
}

/**
 * One of two values by a condition, as an expression that computes both.
 *
 * TSL's own `select` is a branch, and each branch in a loop doubles the number of paths through it: software renderers follow
 * all of them and take minutes to compile the march of a storm. Where one of the values is costly, use `If`.
 */
export const select = ((...values: Parameters<typeof branch>) =>
  nodeObject(new ParenthesesNode(uniformFlow(branch(...values))))) as unknown as typeof branch
