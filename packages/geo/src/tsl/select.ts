import { select as branch, uniformFlow } from 'three/tsl'

/**
 * One of two values by a condition, as an expression that computes both.
 *
 * TSL's own `select` is a branch, and each branch in a loop doubles the number of paths through it: software renderers follow
 * all of them and take minutes to compile the march of a storm. Where one of the values is costly, use `If`.
 */
export const select = ((...values: Parameters<typeof branch>) =>
  uniformFlow(branch(...values))) as unknown as typeof branch
