import { DataUtils, NearestFilter, type RenderTarget, type Texture, Vector2 } from 'three'
import { screenCoordinate, texture, uniform, vec2 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import type { Vec2 } from '../tsl-types'
import { meterForm } from './cpu/meteredLuminance'
import { logLuminance } from './tsl/logLuminance'

/** Samples of a picture, and what it was drawn with. */
export interface MeterReading {
  /** log2 of luminance in the picture's unit, four samples a cell. */
  logs: Float32Array
  /** `luminanceScale` of the picture [1/(cd/m²)]. */
  scale: number
}

/** Draws log2 luminance of a picture to a small texture and reads that back, a frame or more later. */
export class ExposureMeter {
  readonly #picture = texture()
  readonly #size = uniform(new Vector2())
  #target: RenderTarget | null = null
  #pass: FragmentPass | null = null
  /** Read that is under way, or the last. */
  #reading: Promise<void> = Promise.resolve()
  #isReading = false
  /** Counts disposals: what was read before one is dropped. */
  #generation = 0

  /** Settles with the read that is under way; with its error, if it failed. */
  get reading(): Promise<void> {
    return this.#reading
  }

  /**
   * Meters a picture, unless another read is still under way.
   *
   * @param scale - `luminanceScale` that it was drawn with [1/(cd/m²)].
   * @param onRead - Takes the samples.
   */
  meter(
    renderer: Renderer,
    picture: Texture,
    scale: number,
    onRead: (reading: MeterReading) => void
  ): void {
    if (this.#isReading) return
    const { width, height } = picture.image as { width: number; height: number }
    if (picture !== this.#picture.value) this.#freePass()
    this.#picture.value = picture
    this.#size.value.set(width, height)
    this.#draw(renderer)
    this.#isReading = true
    const generation = this.#generation
    this.#reading = this.#read(renderer)
      .then(logs => {
        if (generation === this.#generation) onRead({ logs, scale })
      })
      .catch((error: unknown) => {
        // Nobody misses what was disposed of meanwhile.
        if (generation === this.#generation) throw error
      })
      .finally(() => {
        if (generation === this.#generation) this.#isReading = false
      })
    this.#reading.catch(() => undefined)
  }

  #draw(renderer: Renderer): void {
    const [width, height] = meterForm.cells
    const extent = vec2(1 / width, 1 / height) as Vec2
    this.#target ??= tableTarget('Welkin.Exposure', width, height, 1, NearestFilter)
    this.#pass ??= new FragmentPass(
      'Welkin.Exposure',
      logLuminance(this.#picture, this.#size, screenCoordinate.xy.floor().mul(extent), extent)
    )
    this.#pass.render(renderer, this.#target)
  }

  async #read(renderer: Renderer): Promise<Float32Array> {
    const [width, height] = meterForm.cells
    const halves = await renderer.readRenderTargetPixelsAsync(this.#target!, 0, 0, width, height)
    // `Float32Array.from` takes ten times as long: a millisecond of each frame.
    return new Float32Array(halves as Uint16Array).map(half => DataUtils.fromHalfFloat(half))
  }

  /** Frees its texture. It can be used again. */
  dispose(): void {
    this.#generation++
    this.#isReading = false
    this.#target?.dispose()
    this.#target = null
    this.#freePass()
  }

  /** Its pipeline is of one format of textures. */
  #freePass(): void {
    this.#pass?.dispose()
    this.#pass = null
  }
}
