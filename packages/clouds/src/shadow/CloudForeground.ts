import type { ForegroundLayer } from '@welkin/atmosphere'
import type { CloudsNode } from '../march/CloudsNode'
import { unpack } from '../temporal/tsl/packing'
import type { Float, Vec2 } from '../tsl-types'

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

  octavesAt(at: Vec2): Float {
    return unpack(this.#clouds.passes.accumulated.distances.sample(at).level(0)).x
  }

  transmittanceAt(at: Vec2): Float {
    return this.#clouds.passes.accumulated.light.sample(at).level(0).a.toConst()
  }
}
