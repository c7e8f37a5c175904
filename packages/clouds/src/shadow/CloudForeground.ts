import type { ForegroundLayer } from '@welkin/atmosphere'
import { exp2 } from 'three/tsl'
import type { CloudsNode } from '../march/CloudsNode'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { Float, Vec2, Vec4 } from '../tsl-types'

/** Greatest difference of a smooth distance from history's, and that of another cloud's or none [octaves]. */
const TOLERANCE = 0.6 * DISTANCE_STEP
const OTHER = 1

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

  seenAt(at: Vec2, around?: Float): { distance: Float; transmittance: Float } {
    const { accumulated, marched, viewRays } = this.#clouds.passes
    const { frame } = viewRays
    const read = ({ distances }: CloudTargets, place: Vec2): Vec4 =>
      distances.sample(place).level(0).toConst()
    const kept = unpack(read(accumulated, at)).x
    // History's distances are bytes, whose steps would show in haze; marched ones are smooth, but of pixels nearby.
    const block = at.mul(frame.size).sub(frame.jitter).sub(0.5).div(frame.block).add(0.5)
    const smooth = around ?? read(marched, block.div(frame.marchedSize).toConst()).x
    const off = smooth.sub(kept).toConst() as Float
    const isOther = off.abs().greaterThan(OTHER)
    const near = isOther.select(0, off.clamp(-TOLERANCE, TOLERANCE))
    return {
      distance: exp2(kept.add(near)).toConst(),
      transmittance: accumulated.light.sample(at).level(0).a.toConst()
    }
  }
}
