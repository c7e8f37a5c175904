import type { PerspectiveCamera } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { TimestampQuery } from 'three'
import { overlayOn } from '../overlay'

/** Time between two readings [ms]. */
const PERIOD = 500

/** Position, hour and times of a frame in a corner of the canvas. */
export class Readout {
  readonly #element: HTMLElement
  #frames = 0
  #cpu = 0
  #since = performance.now()
  #isReading = false
  #gpu: number | null = null

  constructor(canvas: HTMLCanvasElement) {
    this.#element = overlayOn(canvas)
    // It changes twice a second: nothing to be read out.
    this.#element.role = 'none'
    Object.assign(this.#element.style, { textAlign: 'right', fontVariantNumeric: 'tabular-nums' })
  }

  /**
   * Counts a frame that was drawn.
   *
   * @param milliseconds - Time that it took on the CPU [ms].
   * @param hour - Solar time [h].
   */
  update(
    renderer: WebGPURenderer,
    camera: PerspectiveCamera,
    ground: number,
    hour: number,
    milliseconds: number
  ): void {
    this.#frames++
    this.#cpu += milliseconds
    if (!this.#isReading) void this.#read(renderer)
    const now = performance.now()
    const elapsed = now - this.#since
    if (elapsed < PERIOD) return
    const { x, y, z } = camera.position
    const minutes = Math.floor((hour % 1) * 60)
    const clock = `${Math.floor(hour)}:${String(minutes).padStart(2, '0')}`
    const gpu = this.#gpu === null ? '' : ` · GPU ${this.#gpu.toFixed(1)} ms`
    const cpu = (this.#cpu / this.#frames).toFixed(1)
    this.#element.textContent =
      `${clock} · east ${x.toFixed(0)} m, north ${(-z).toFixed(0)} m · ` +
      `${(y - ground).toFixed(1)} m above ground\n` +
      `${((1000 * this.#frames) / elapsed).toFixed(0)} frames/s · CPU ${cpu} ms${gpu}`
    this.#frames = this.#cpu = 0
    this.#since = now
  }

  /** Reads the GPU's time where the backend keeps it. */
  async #read(renderer: WebGPURenderer): Promise<void> {
    this.#isReading = true
    const time = await renderer.resolveTimestampsAsync(TimestampQuery.RENDER).catch(() => null)
    if (typeof time === 'number' && time > 0) this.#gpu = time
    this.#isReading = false
  }

  dispose(): void {
    this.#element.remove()
  }
}
