import { nodeProxy, type select as branch } from 'three/tsl'
import { ConditionalNode } from 'three/webgpu'
import type { NodeBuilder } from 'three/webgpu'

/** A builder with what @types/three 0.187 lacks of it. */
type Builder = NodeBuilder & {
  getTernary(condition: string, ifTrue: string, ifFalse: string): string
  format(snippet: string, type: string, output?: string | null): string
}

/** As three's own writes it for `uniformFlow`, where it is wrong if it is read twice, and has no parentheses in GLSL. */
class SelectNode extends ConditionalNode<unknown> {
  // As any expression: read twice, it is computed once.
  override isCacheable(): boolean {
    return true
  }

  override generate(builder: NodeBuilder, output?: string | null): string {
    const type = this.getNodeType(builder)
    const writer = builder as Builder
    const chosen = writer.getTernary(
      this.condNode.build(builder, 'bool') as string,
      this.ifNode.build(builder, type) as string,
      this.elseNode!.build(builder, type) as string
    )
    return writer.format(`( ${chosen} )`, type, output)
  }
}

/**
 * One of two values by a condition, as an expression that computes both.
 *
 * TSL's own `select` is a branch, and each branch in a loop doubles the number of paths through it: software renderers follow
 * all of them and take minutes to compile the march of a storm. Where one of the values is costly, use `If`.
 */
export const select = /* @__PURE__ */ nodeProxy(SelectNode as never) as unknown as typeof branch
