import type { CloudPhaseParameters } from './cloudPhase'

/** Asymmetry of the second lobe of droplets: their light from 100° on, but for bow and glory. */
const BACK = -0.3

/**
 * Lobes that have the moments χ₁ and χ₃ of droplets' phase function: for light that is scattered more than once.
 *
 * @param moments - Legendre coefficients χ₁ to χ₃.
 */
export function dropletLobes(
  moments: readonly [number, number, number]
): Omit<CloudPhaseParameters, 'scatteringAlbedo'> {
  const [first, , third] = moments
  const shareOf = (g: number): number => (first - BACK) / (g - BACK)
  let [low, high] = [first, 0.95]
  for (let i = 0; i < 40; i++) {
    const g = (low + high) / 2
    if (shareOf(g) * (g ** 3 - BACK ** 3) + BACK ** 3 < third) low = g
    else high = g
  }
  return { forwardAsymmetry: low, backwardAsymmetry: BACK, forwardShare: shareOf(low) }
}
