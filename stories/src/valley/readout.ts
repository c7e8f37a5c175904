import type { DayCycle } from '@welkin/atmosphere'
import type { PerspectiveCamera } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { overlayOn } from '../overlay'
import { clockOf } from './clock'
import { PassTimes, type PassTime } from './PassTimes'
import { gpuText, type LastPass } from './shares'

/** Time between two readings [ms]. */
const PERIOD = 500

const DATE = new Intl.DateTimeFormat('en-GB', { day: 'numeric', month: 'long', timeZone: 'UTC' })

/** Position, date, hour and times of a frame in a corner of the canvas. */
export class Readout {
  readonly #element: HTMLElement
  readonly #renderer: WebGPURenderer
  readonly #times = new PassTimes()
  #frames = 0
  #cpu = 0
  #since = performance.now()
  #isReading = false
  /** Times of the passes since the last reading, and the frames that they are of. */
  #passes: PassTime[] = []
  #timedFrames = 0
  /** Readings until now, true once one had times, and what it says. */
  #readings = 0
  #hadTimes = false
  #gpu = ''

  constructor(canvas: HTMLCanvasElement, renderer: WebGPURenderer) {
    this.#renderer = renderer
    renderer.inspector = this.#times
    this.#element = overlayOn(canvas)
    // It changes twice a second: nothing to be read out.
    this.#element.role = 'none'
    Object.assign(this.#element.style, { textAlign: 'right', fontVariantNumeric: 'tabular-nums' })
  }

  /**
   * Counts a frame that was drawn.
   *
   * @param ground - Height of the ground below the camera [m].
   * @param cycle - Clock of the scene.
   * @param effects - Post effects that are on.
   * @param milliseconds - Time that it took on the CPU [ms].
   */
  update(
    camera: PerspectiveCamera,
    ground: number,
    cycle: DayCycle,
    effects: LastPass,
    milliseconds: number
  ): void {
    this.#frames++
    this.#cpu += milliseconds
    if (!this.#isReading) void this.#read()
    const now = performance.now()
    const elapsed = now - this.#since
    if (elapsed < PERIOD) return
    const { x, y, z } = camera.position
    const clock = `${DATE.format(cycle.time)}, ${clockOf(cycle.hour)}`
    const cpu = (this.#cpu / this.#frames).toFixed(1)
    const hasTimes = this.#timedFrames > 0
    // The last ones stay until there are others.
    if (hasTimes || !this.#hadTimes) {
      this.#gpu = gpuText(this.#passes, this.#timedFrames, this.#readings, effects)
    }
    this.#hadTimes ||= hasTimes
    this.#element.textContent =
      `${clock} · east ${x.toFixed(0)} m, north ${(-z).toFixed(0)} m · ` +
      `${(y - ground).toFixed(1)} m above ground\n` +
      `${((1000 * this.#frames) / elapsed).toFixed(0)} frames/s · CPU ${cpu} ms${this.#gpu}`
    this.#frames = this.#cpu = this.#timedFrames = 0
    this.#passes = []
    this.#since = now
  }

  /** Reads the GPU's times where the backend keeps them. */
  async #read(): Promise<void> {
    this.#isReading = true
    const { passes, frames } = await this.#times
      .read(this.#renderer)
      .catch(() => ({ passes: [], frames: 0 }))
    this.#passes.push(...passes)
    this.#timedFrames += frames
    this.#readings++
    this.#isReading = false
  }

  dispose(): void {
    this.#element.remove()
  }
}
