import { RenderTarget } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Street } from '../../stories/src/street/Street'
import type { StreetStill } from './streets'
import { finish } from './finish'
import { readPicture } from './readPicture'

/** Time of fall [s]. */
const TIME = 60

/** A street in rain or snow, its clock stopped. */
export class StreetView {
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #street: Street
  /** Picture whose edges are smoothed. */
  readonly #shown: { dispose(): void }

  constructor(
    renderer: WebGPURenderer,
    { street }: StreetStill,
    [width, height]: readonly [number, number]
  ) {
    this.#renderer = renderer
    this.#target = new RenderTarget(width, height)
    this.#street = new Street(renderer, TIME)
    this.#street.set(street)
    this.#shown = finish(this.#street.pipeline, this.#street.exposure)
    this.#street.camera.aspect = width / height
    this.#street.camera.updateProjectionMatrix()
  }

  /** Luminance that it is exposed for [cd/m²]. */
  get luminance(): number {
    return this.#street.exposure.luminance ?? NaN
  }

  /** Exposes the next picture as the last one asks for. */
  async expose(): Promise<void> {
    await this.#street.exposure.settle()
  }

  /** Makes tables: the first picture has its air. */
  async bake(): Promise<void> {
    await this.#street.atmosphere.bake(this.#renderer)
  }

  draw(): void {
    this.#renderer.setRenderTarget(this.#target)
    this.#street.render()
    this.#renderer.setRenderTarget(null)
  }

  /** Picture of the canvas as a viewer sees it, RGBA, rows top-down. */
  picture(): Promise<Uint8Array> {
    return readPicture(this.#renderer, this.#target)
  }

  dispose(): void {
    this.#street.dispose()
    this.#shown.dispose()
    this.#target.dispose()
  }
}
