import type { Veil } from '@welkin/atmosphere'
import { exp2 } from 'three/tsl'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { CloudRenderer } from './CloudRenderer'

/** Steps of kept distances by which a marched one near them may differ. */
const NEARBY = 0.6

/** Part of the texture of marched pixels, and the distances of these. */
export type VeilTextures = Pick<CloudRenderer, 'accumulated' | 'marched' | 'frame'>

/**
 * Clouds as light shafts see them: drawn over the air, half opaque.
 *
 * @param drawn - What was drawn last; asked for when a shader is made.
 */
export function cloudVeil(
  clouds: { readonly isDisposed: boolean },
  drawn: () => VeilTextures
): Veil & { isRemoved: boolean } {
  return {
    isRemoved: false,
    get isDrawn() {
      return !this.isRemoved && !clouds.isDisposed
    },
    seenAt(at) {
      const { accumulated, marched, frame } = drawn()
      const read = ({ distances }: CloudTargets, place: typeof at) =>
        distances.sample(place).level(0).toConst()
      const kept = unpack(read(accumulated, at)).x
      // Those kept have steps, which would show in haze; those of this frame have not, but are of pixels nearby.
      const block = at.mul(frame.size).sub(frame.jitter).sub(0.5).div(frame.block).add(0.5)
      const fine = read(marched, block.div(frame.marchedSize).toConst()).x
      const within = NEARBY * DISTANCE_STEP
      return {
        distance: exp2(fine.clamp(kept.sub(within), kept.add(within))).toConst(),
        transmittance: accumulated.light.sample(at).level(0).a.toConst()
      }
    }
  }
}
