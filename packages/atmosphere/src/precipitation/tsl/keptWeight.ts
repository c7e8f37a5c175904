import type { Float } from '../../tsl-types'

/** Part of the last kept particles that fade, over the share that is left out: none pops. */
const FADING = 0.2

/**
 * Opacity of a particle over that of a real one, for those that a class keeps at a distance; 0 for others [–].
 *
 * Of n particles in random order the first n k are kept, k = min(1, (fullReach/part)²), and the last of them fade in on the way to the camera. Their mean is
 * 1: a view is as opaque as with all. Inverse of k: `keptReach` in cpu/drawnParticles.ts
 *
 * @param fullReach - `ParticleKind.fullReach` of its class.
 * @param order - Place of the particle in the order, over n, ≥ 0 [–].
 * @param part - Distance over the class's reach, ≥ 0 [–].
 */
export function keptWeight(fullReach: Float, order: Float, part: Float): Float {
  const near = part.max(fullReach).reciprocal().mul(fullReach).toConst() as Float
  const kept = near.mul(near).toConst() as Float
  const fading = kept.oneMinus().mul(FADING).toConst() as Float
  const shown = kept.sub(order).div(kept.mul(fading).max(1e-6)).clamp()
  return shown.div(kept.mul(fading.mul(-0.5).add(1)))
}
