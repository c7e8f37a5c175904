import type { DayCycle } from '@welkin/atmosphere'
import type { PerspectiveCamera } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { overlayOn } from '../overlay'
import { clockOf } from './clock'
import { PassTimes, type PassTime } from './PassTimes'
import { FeatureMeter } from './FeatureMeter'
import { meteredFeatures } from './meteredFeatures'
import { featureText, gpuText, type LastPass } from './shares'
import type { ValleyState } from './Valley'

/** Time between two readings [ms]. */
const PERIOD = 500

/** Labels of the button. */
const MEASURE = 'Measure each feature'
const STOP = 'Stop'

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
  readonly #text = document.createElement('div')
  readonly #button = document.createElement('button')
  readonly #meter: FeatureMeter<Partial<ValleyState>>
  #lastFrame = performance.now()

  /** @param set - Follows changes of the valley's state; undefined has it as its controls say. */
  constructor(
    canvas: HTMLCanvasElement,
    renderer: WebGPURenderer,
    state: () => ValleyState,
    set: (changes: Partial<ValleyState> | undefined) => void
  ) {
    this.#renderer = renderer
    this.#meter = new FeatureMeter(set)
    renderer.inspector = this.#times
    this.#element = overlayOn(canvas)
    // It changes twice a second: nothing to be read out.
    this.#element.role = 'none'
    Object.assign(this.#element.style, { textAlign: 'right', fontVariantNumeric: 'tabular-nums' })
    Object.assign(this.#button.style, { pointerEvents: 'auto', font: 'inherit' })
    this.#button.textContent = MEASURE
    this.#button.addEventListener('click', () => {
      if (this.#meter.isMeasuring) this.#meter.stop()
      else this.#meter.start(meteredFeatures(state()))
    })
    this.#element.append(this.#text, this.#button)
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
    const drawn = performance.now()
    this.#meter.update((drawn - this.#lastFrame) / 1000)
    this.#lastFrame = drawn
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
    const { isMeasuring, current: feature, shares } = this.#meter
    // Without times there is nothing to measure.
    this.#button.hidden = !this.#hadTimes
    this.#button.textContent = isMeasuring ? `${STOP}: ${feature}` : MEASURE
    this.#text.textContent =
      `${clock} · east ${x.toFixed(0)} m, north ${(-z).toFixed(0)} m · ` +
      `${(y - ground).toFixed(1)} m above ground\n` +
      `${((1000 * this.#frames) / elapsed).toFixed(0)} frames/s · CPU ${cpu} ms${this.#gpu}` +
      featureText(shares)
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
    const spent = passes.reduce((sum, [, milliseconds]) => sum + milliseconds, 0)
    this.#meter.take(spent, frames)
    this.#readings++
    this.#isReading = false
  }

  /** Ends a measurement: the state is another now. */
  reset(): void {
    this.#meter.stop()
  }

  dispose(): void {
    this.#element.remove()
  }
}
