import type { ForegroundLayer } from '@welkin/atmosphere'
import { exp2 } from 'three/tsl'
import type { CloudsNode } from '../march/CloudsNode'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { Float, Vec2, Vec4 } from '../tsl-types'

/** Steps of kept distances by which a marched one near them may differ. */
const NEARBY = 0.6

/** Clouds as light shafts see them: drawn over the air, half opaque. */
export class CloudForeground implements ForegroundLayer {
  readonly #clouds: CloudsNode
  /** True once the shafts have no shadow of the clouds any more. */
  isRemoved = false

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
  }

  get isDrawn(): boolean {
    return !this.isRemoved && !this.#clouds.isDisposed
  }

  seenAt(at: Vec2): { distance: Float; transmittance: Float } {
    const { accumulated, marched, frame } = this.#clouds.passes
    const read = ({ distances }: CloudTargets, place: Vec2): Vec4 =>
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
