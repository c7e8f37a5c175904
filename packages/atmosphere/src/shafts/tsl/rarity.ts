import { log2, mix } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** Least 1/τ² of what is seen through a foreground [–]. */
export const LEAST_RARITY = 1e-6

/** Part of the light of clear air without end that comes from an optical path τ: much as 1 − exp(−τ) is τ/√(1 + τ²), by 1/τ². */
export const shownOf = (rarity: Float): Float => rarity.add(1).inverseSqrt().toConst()

/** 1/τ² by log₂ τ, and the other way round. */
export const rarityAt = (depth: Float): Float => depth.mul(-2).exp2().toConst()
export const depthOf = (rarity: Float): Float => log2(rarity).mul(-0.5).toConst()

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
