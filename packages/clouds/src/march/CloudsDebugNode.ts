import { checkChoice } from '@welkin/geo'
import { Fn, If, exp2, uv, vec3, vec4 } from 'three/tsl'
import { Node } from 'three/webgpu'
import { checkClouds } from '../check'
import { unpack } from '../temporal/tsl/packing'
import type { Vec2, Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import type { CloudsNode } from './CloudsNode'

/** Quantity shown instead of clouds, for debugging: white is most. */
export type CloudsDebug =
  /** Opacity of the clouds all along the line of sight. */
  | 'density'
  /** Steps of the last ray marched nearby, of 256. */
  | 'steps'
  /** Distance, by its logarithm: black at 100 m, white at 1000 km. */
  | 'depth'
  /** Accumulated samples of a pixel, of 32. */
  | 'history'

const views: readonly (CloudsDebug | null)[] = ['density', 'steps', 'depth', 'history', null]

/**
 * Debug view of clouds: draws them, and shows what lies behind the picture.
 *
 * ```ts
 * pipeline.outputNode = cloudsDebug(cloudsNode, 'steps')
 * ```
 */
export class CloudsDebugNode extends Node<'vec4'> {
  static get type(): string {
    return 'CloudsDebugNode'
  }

  /** Shared, not owned. */
  readonly clouds: CloudsNode
  /** Index of the view. */
  readonly #index = number()

  /** @throws If the clouds are missing, or there is no such view. */
  constructor(clouds: CloudsNode, view: CloudsDebug | null) {
    super('vec4')
    checkClouds('CloudsDebugNode', clouds)
    this.clouds = clouds
    this.view = view
  }

  /** Quantity shown; null for the clouds themselves. Nothing is compiled when it changes. */
  get view(): CloudsDebug | null {
    return views[this.#index.value]
  }

  /** @throws If there is no such view. */
  set view(view: CloudsDebug | null) {
    checkChoice('CloudsDebugNode', 'view', view, views)
    this.#index.value = views.indexOf(view)
  }

  override setup(): Node {
    return Fn(() => {
      const shown = vec4(this.clouds).toVar() as Vec4
      const { accumulated, marched } = this.clouds.passes
      const at = uv() as unknown as Vec2
      const { a: transmittance } = accumulated.light.sample(at).level(0).toConst()
      const distances = unpack(accumulated.distances.sample(at).level(0).toConst())
      const { x: distance, z: samples } = distances
      const values = [
        transmittance.oneMinus(),
        marched.distances.sample(at).level(0).w,
        exp2(distance).log().sub(Math.log(100)).div(Math.log(1e4)).clamp(),
        samples.abs().div(32)
      ]
      values.forEach((value, i) => {
        If(this.#index.equal(i), () => {
          shown.assign(vec4(vec3(value), 1))
        })
      })
      return shown
    })()
  }
}

/** Debug view of clouds: see {@link CloudsDebugNode}. */
export const cloudsDebug = (clouds: CloudsNode, view: CloudsDebug | null): CloudsDebugNode =>
  new CloudsDebugNode(clouds, view)
