import { RenderTarget } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Street } from '../../stories/src/street/Street'
import type { StreetStill } from './streets'

/** Time of fall [s]. */
const TIME = 60

/** The street of the story, its clock stopped. */
export class StreetView {
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #street: Street

  constructor(
    renderer: WebGPURenderer,
    { street }: StreetStill,
    [width, height]: readonly [number, number]
  ) {
    this.#renderer = renderer
    this.#target = new RenderTarget(width, height)
    this.#street = new Street(renderer, TIME)
    this.#street.set(street)
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
  async picture(): Promise<Uint8Array> {
    const { width, height } = this.#target
    const pixels = this.#renderer.readRenderTargetPixelsAsync(this.#target, 0, 0, width, height)
    return (await pixels) as Uint8Array
  }

  dispose(): void {
    this.#street.dispose()
    this.#target.dispose()
  }
}
