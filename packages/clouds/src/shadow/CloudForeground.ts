import type { ForegroundLayer } from '@welkin/atmosphere'
import { exp2 } from 'three/tsl'
import type { CloudsNode } from '../march/CloudsNode'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { Float, Vec2, Vec4 } from '../tsl-types'

/** Clouds as light shafts see them: drawn over the air, half opaque. */
export class CloudForeground implements ForegroundLayer {
  readonly #clouds: CloudsNode
  readonly tolerance = 0.6 * DISTANCE_STEP
  /** True once the shafts have no shadow of the clouds any more. */
  isRemoved = false

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
  }

  get isDrawn(): boolean {
    return !this.isRemoved && !this.#clouds.isDisposed
  }

  distanceAt(at: Vec2, isRough: boolean): Float {
    const { accumulated, marched, viewRays } = this.#clouds.passes
    const { frame } = viewRays
    const read = ({ distances }: CloudTargets, place: Vec2): Vec4 =>
      distances.sample(place).level(0).toConst()
    const kept = unpack(read(accumulated, at)).x
    if (isRough) return exp2(kept).toConst()
    // History's distances are bytes, whose steps would show in haze; marched ones are smooth, but of pixels nearby.
    const block = at.mul(frame.size).sub(frame.jitter).sub(0.5).div(frame.block).add(0.5)
    const smooth = read(marched, block.div(frame.marchedSize).toConst()).x
    const near = smooth.clamp(kept.sub(this.tolerance), kept.add(this.tolerance))
    return exp2(near).toConst()
  }

  transmittanceAt(at: Vec2): Float {
    return this.#clouds.passes.accumulated.light.sample(at).level(0).a.toConst()
  }
}
