import type { Float } from '../../tsl-types'
import { rarityAt } from './rarity'

/** Difference in the light of clear air at which a pixel counts half [octaves]. Greater: halos at silhouettes. */
export const SIMILAR = 0.02

/** Difference in light at which a pixel counts half before clouds, whose depths are rough [octaves]. Smaller: grain, where few of those around count; greater: dark fringes at edges of clouds (*Sun behind cumulus*). */
export const ROUGH = 0.1

/** Octaves of depth by which pixels differ at least that much, however alike their light is. Smaller: ground at the horizon has the sky's. */
export const DISTINCT = 0.25

/**
 * Weight of another pixel's samples by how much its air is like this one's: a joint bilateral weight.
 *
 * @param rarity - 1/τ² of this pixel's air.
 * @param own - log₂ depth of the same.
 * @param depth - log₂ depth of the other.
 * @param similar - Difference in light at which it counts half [octaves].
 */
export function depthWeight(rarity: Float, own: Float, depth: Float, similar: number): Float {
  const light = rarity.add(1).div(rarityAt(depth).add(1)).log2().mul(0.5)
  const apart = depth.sub(own).abs().min(DISTINCT).max(light.abs()).toConst()
  return apart
    .mul(apart)
    .add(similar ** 2)
    .reciprocal()
    .toConst()
}
