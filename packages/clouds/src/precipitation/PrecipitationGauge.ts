import { FragmentPass, tableTarget } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import { DataUtils, Vector3 } from 'three'
import { Fn, float, vec3, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkClouds } from '../check'
import { viewpointMapped } from '../density/CloudField'
import { forLayers, layerAt } from '../density/tsl/layer'
import type { CloudSample } from '../density/tsl/sample'
import type { CloudsNode } from '../march/CloudsNode'
import type { Variable, Vec3 } from '../tsl-types'
import { vector3 } from '../uniforms'
import { PrecipitationShafts } from './PrecipitationShafts'
import { fallenFrom } from './tsl/fall'

/** Width of the ground over which rates are means [m]. */
const WIDTH = 50
/** Greatest rate, which layers, `rainfall`, `snowfall` and `raindrops` take [mm/h]. */
const MOST = 300
/** Texels of a row: WebGPU reads back rows of 256 bytes. */
const TEXELS = 32

const _viewpoint = new Vector3()

/**
 * Rates of what falls at a place from the clouds above it, by the same field as their shafts: for near rain and wet ground.
 *
 * ```ts
 * const gauge = new PrecipitationGauge(cloudsNode) // of clouds with a `precipitation`
 * // In each frame, after the clouds are drawn:
 * gauge.update(renderer, camera.position)
 * rain.rate = gauge.rain
 * snow.rate = gauge.snow
 * ```
 *
 * The GPU answers some frames later. A rate is the mean over 50 m of ground, and 300 mm/h at most.
 */
export class PrecipitationGauge {
  /** Clouds from which it falls; shared, not owned. */
  readonly clouds: CloudsNode
  #rates: readonly number[] = [0, 0, 0]
  #isReading = false
  #isDisposed = false
  readonly #offset = vector3()
  readonly #target = tableTarget('Welkin.PrecipitationGauge', TEXELS, 1)
  readonly #pass: FragmentPass

  /** @throws If the clouds are none, or have no `precipitation`. */
  constructor(clouds: CloudsNode) {
    checkClouds('PrecipitationGauge', clouds)
    const { falling } = clouds.shadows
    if (!(falling instanceof PrecipitationShafts)) {
      fail('PrecipitationGauge', 'clouds must have a precipitation')
    }
    this.clouds = clouds
    const { field } = clouds
    this.#pass = new FragmentPass(
      'Welkin.PrecipitationGauge',
      Fn(() => {
        const offset = this.#offset as unknown as Vec3
        const { altitude, up } = field.view.localCoordinates(offset)
        const distance = float(WIDTH).div(field.pixelAngle).toConst()
        const sample: CloudSample = { offset, altitude, up, distance }
        const rates = vec3(0).toVar() as Variable<Vec3>
        forLayers(field, index => {
          const layer = layerAt(field, index)
          const { rate, hail, snow } = fallenFrom(
            field,
            undefined,
            layer,
            falling.fallOf(index),
            sample
          )
          rates.addAssign(vec3(rate.mul(snow.oneMinus()), rate.mul(snow), hail))
        })
        return vec4(rates.min(MOST), 1)
      })()
    )
  }

  /** Rate of rain [mm/h]. */
  get rain(): number {
    return this.#rates[0]
  }

  /** Rate of snow, as water [mm/h]. */
  get snow(): number {
    return this.#rates[1]
  }

  /** Rate of hail, as water [mm/h]. */
  get hail(): number {
    return this.#rates[2]
  }

  /** True while the GPU has not answered the last question. */
  get isReading(): boolean {
    return this.#isReading
  }

  /**
   * Asks for the rates at a place, unless the GPU has not answered yet.
   *
   * @param position - The place, in world space.
   */
  update(renderer: Renderer, position: Vector3): void {
    const { field, camera } = this.clouds
    if (this.#isReading || this.#isDisposed || !field.isReady) return
    if ([...field.layers].every(layer => !layer.precipitation?.rate)) {
      this.#rates = [0, 0, 0]
      return
    }
    const view = field.view.update({ camera })
    if (view === undefined) return
    view.atmosphere.space.position(position, this.#offset.value)
    this.#offset.value.sub(viewpointMapped(view, _viewpoint))
    this.#pass.render(renderer, this.#target)
    this.#isReading = true
    void renderer
      .readRenderTargetPixelsAsync(this.#target, 0, 0, TEXELS, 1)
      .then(pixels => {
        this.#rates = [0, 1, 2].map(i => DataUtils.fromHalfFloat((pixels as Uint16Array)[i]))
      })
      .finally(() => {
        this.#isReading = false
      })
  }

  /** Frees its texture. */
  dispose(): void {
    this.#isDisposed = true
    this.#target.dispose()
    this.#pass.dispose()
  }
}
