import type { Float } from '../../tsl-types'
import { rarityAt } from './rarity'

/** Octaves of the light of clear air by which pixels differ that weigh half as much as those that have the same. Greater: halos at silhouettes. */
export const SIMILAR = 0.02

/** Octaves that weigh half before clouds, whose depths are rough. Smaller: grain, where few of those around count; greater: dark fringes at edges of clouds (*Sun behind cumulus*). */
export const ROUGH = 0.1

/** Octaves of depth by which pixels differ at least that much, however alike their light is. Smaller: ground at the horizon has the sky's. */
const DISTINCT = 0.25

/**
 * Weight of a pixel by how near its air is to another's, by light and depth.
 *
 * @param rarity - 1/τ² of the other, and its depth `own`.
 * @param similar - Octaves by which it weighs half.
 */
export function nearness(rarity: Float, own: Float, depth: Float, similar: number): Float {
  const light = rarity.add(1).div(rarityAt(depth).add(1)).log2().mul(0.5)
  const apart = depth.sub(own).abs().min(DISTINCT).max(light.abs()).toConst()
  return apart
    .mul(apart)
    .add(similar ** 2)
    .reciprocal()
    .toConst()
}
