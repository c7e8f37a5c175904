import type { ForegroundLayer } from '@welkin/atmosphere'
import type { CloudsNode } from '../march/CloudsNode'
import { DISTANCE_STEP, unpack } from '../temporal/tsl/packing'
import type { CloudTargets } from '../temporal/tsl/renderTargets'
import type { Float, Vec2, Vec4 } from '../tsl-types'

/** Clouds as light shafts see them: drawn over the air, half opaque. */
export class CloudForeground implements ForegroundLayer {
  readonly #clouds: CloudsNode
  readonly tolerance = 1.5 * DISTANCE_STEP
  /** True once the shafts have no shadow of the clouds any more. */
  isRemoved = false

  constructor(clouds: CloudsNode) {
    this.#clouds = clouds
  }

  get isDrawn(): boolean {
    return !this.isRemoved && !this.#clouds.isDisposed
  }

  octavesAt(at: Vec2, isRough: boolean): Float {
    const { accumulated, cells, viewRays } = this.#clouds.passes
    const { frame } = viewRays
    const read = ({ distances }: CloudTargets, place: Vec2): Vec4 =>
      distances.sample(place).level(0).toConst()
    const kept = unpack(read(accumulated, at)).x
    if (isRough) return kept.toConst()
    // History's distances are bytes, of a cell each, whose steps would show in haze: means of cells around are smooth.
    const place = at.mul(frame.size).sub(0.5).sub(frame.jitter).div(frame.block).add(1)
    const smooth = read(cells, place.div(frame.marchedSize.add(1)).toConst()).x
    return smooth.clamp(kept.sub(this.tolerance), kept.add(this.tolerance)).toConst()
  }

  transmittanceAt(at: Vec2): Float {
    return this.#clouds.passes.accumulated.light.sample(at).level(0).a.toConst()
  }
}
