import { log2, mix } from 'three/tsl'
import type { Bool, Float, Vec4 } from '../../tsl-types'

/** Square of the light of clear air over what a foreground leaves of it, at least, to be told from none. Less: thin clouds have the light of the air behind them. */
const LEAST_HIDDEN = 1.6

/** Least 1/τ² of what is seen through a foreground [–]. */
const LEAST_RARITY = 1e-6

/** Part of the light of clear air without end that comes from an optical path τ: much as 1 − exp(−τ) is τ/√(1 + τ²), by 1/τ². */
export const shownOf = (rarity: Float): Float => rarity.add(1).inverseSqrt().toConst()

/** 1/τ² by log₂ τ, and the other way round. */
export const rarityAt = (depth: Float): Float => depth.mul(-2).exp2().toConst()
export const depthOf = (rarity: Float): Float => log2(rarity).mul(-0.5).toConst()

/**
 * True if pixels around have a foreground before clear air that accounts for a pixel's own: as much light is seen as passes it
 * from behind, or more, and less than without it.
 *
 * @param behind - 1/τ² up to what is behind the foreground.
 */
export function hasForeground(mean: Vec4, behind: Float, transmittance: Float): Bool {
  // Reciprocal squares of what is shown. Those that are marked show all.
  const [around, clear] = [rarityAt(mean.w), behind].map(rarity => rarity.add(1).toConst())
  const isNearer = around.greaterThan(clear.mul(LEAST_HIDDEN))
  return isNearer.and(around.mul(transmittance).mul(transmittance).lessThan(clear))
}

/**
 * 1/τ² of a foreground, through which a part passes of what is behind: each has its part of the light that is seen.
 *
 * @param front - 1/τ² up to the foreground.
 * @param behind - That up to what is behind it; the greatest where that is not seen.
 */
export function rarityThrough(front: Float, behind: Float, transmittance: Float): Float {
  const shown = mix(shownOf(front), shownOf(behind), transmittance).toConst()
  return shown.mul(shown).reciprocal().sub(1).max(LEAST_RARITY)
}
