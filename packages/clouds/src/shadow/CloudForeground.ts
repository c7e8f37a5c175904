import type { ForegroundLayer } from '@welkin/atmosphere'
import { exp2 } from 'three/tsl'
import type { CloudsNode } from '../march/CloudsNode'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { Float, Vec2 } from '../tsl-types'

/** Greatest difference of a marched distance from history's [steps of packed distances]. */
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

  keptAt(at: Vec2): { octaves: Float; tolerance: number; transmittance: Float } {
    const { light, distances } = this.#clouds.passes.accumulated
    return {
      octaves: unpack(distances.sample(at).level(0).toConst()).x,
      tolerance: NEARBY * DISTANCE_STEP,
      transmittance: light.sample(at).level(0).a.toConst()
    }
  }

  seenAt(at: Vec2): { distance: Float; transmittance: Float } {
    const { marched, viewRays } = this.#clouds.passes
    const { frame } = viewRays
    const { octaves, tolerance, transmittance } = this.keptAt(at)
    // History's distances are bytes, whose steps would show in haze; marched ones are smooth, but of pixels nearby.
    const block = at.mul(frame.size).sub(frame.jitter).sub(0.5).div(frame.block).add(0.5)
    const near = marched.distances.sample(block.div(frame.marchedSize).toConst()).level(0).x
    const distance = exp2(near.clamp(octaves.sub(tolerance), octaves.add(tolerance))).toConst()
    return { distance, transmittance }
  }
}
