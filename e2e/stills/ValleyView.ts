import type { CloudQuality, CloudQualityName } from '@welkin/clouds'
import { RenderTarget } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { Valley } from '../../stories/src/valley/Valley'
import { openingState } from '../../stories/src/valley/openingState'
import type { ValleyStill } from './Still'
import { readPicture } from './readPicture'

/** Time of waves and clouds [s]. */
const TIME = 100

/** The valley of the story, its clock stopped. */
export class ValleyView {
  readonly #renderer: WebGPURenderer
  readonly #target: RenderTarget
  readonly #valley: Valley

  constructor(
    renderer: WebGPURenderer,
    { valley: { view, ...changes } }: ValleyStill,
    [width, height]: readonly [number, number],
    quality: CloudQualityName | CloudQuality
  ) {
    this.#renderer = renderer
    this.#target = new RenderTarget(width, height)
    const valley = new Valley(renderer, { ...openingState, ...changes, quality, paused: true })
    valley.lookFrom(view)
    valley.camera.aspect = width / height
    valley.camera.updateProjectionMatrix()
    valley.time = TIME
    this.#valley = valley
  }

  /** Luminance that it is exposed for [cd/m²]. */
  get luminance(): number {
    return this.#valley.exposure.luminance ?? NaN
  }

  /** Exposes the next picture as the last one asks for. */
  async expose(): Promise<void> {
    await this.#valley.exposure.settle()
  }

  /** Makes tables and noise: the first picture has clouds. */
  async bake(): Promise<void> {
    await this.#valley.bake(this.#renderer)
  }

  draw(): void {
    this.#renderer.setRenderTarget(this.#target)
    this.#valley.render(0)
    this.#renderer.setRenderTarget(null)
  }

  /** Picture of the canvas as a viewer sees it, RGBA, rows top-down. */
  picture(): Promise<Uint8Array> {
    return readPicture(this.#renderer, this.#target)
  }

  dispose(): void {
    this.#valley.dispose()
    this.#target.dispose()
  }
}
