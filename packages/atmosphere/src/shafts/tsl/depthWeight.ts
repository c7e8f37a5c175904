import type { Float } from '../../tsl-types'

/** Difference in the light of clear air at which a pixel counts half [octaves]. Greater: halos at silhouettes. */
export const SIMILAR = 0.02

/** Difference in light at which a pixel counts half before clouds, whose depths are rough [octaves]. Smaller: grain, where few of those around count; greater: dark fringes at edges of clouds (*Sun behind cumulus*). */
export const ROUGH = 0.1

/** Octaves of depth by which pixels differ at least that much, however alike their light is. Smaller: ground at the horizon has the sky's. */
const DISTINCT = 0.25

/** Air of a pixel: its log₂ depth, and the part of the light of clear air that it shows. */
export interface ShownAir {
  readonly depth: Float
  readonly shown: Float
}

/**
 * Weight of another pixel's samples by how much its air is like this one's: a joint bilateral weight.
 *
 * @param similar - Difference in light at which it counts half [octaves].
 */
export function depthWeight(own: ShownAir, other: ShownAir, similar: number): Float {
  // In octaves where it is little, at no logarithm.
  const light = other.shown.sub(own.shown).div(own.shown).mul(Math.LOG2E)
  const apart = other.depth.sub(own.depth).abs().min(DISTINCT).max(light.abs()).toConst()
  return apart
    .mul(apart)
    .add(similar ** 2)
    .reciprocal()
    .toConst()
}
