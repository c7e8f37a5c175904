/** A feature of a scene that can be switched off while it runs. */
export interface MeteredFeature<Off> {
  readonly name: string
  /** Changes of the state that switch it off. */
  readonly off: Off
}

/** GPU time that frames take less without a feature [ms]. */
export interface FeatureShare {
  readonly name: string
  readonly milliseconds: number
}

/** Time after a switch in which shaders are compiled and shadows, exposure and old pictures follow, and readings are late [s]. */
const SETTLING = 0.8
/** Frames after a switch that count as little. */
const SETTLING_FRAMES = 12
/**
 * Time of a measurement, of which the mean counts, and its least number of frames with times: some work is done in
 * every fourth or eighth frame only [s].
 */
const MEASURING = 0.8
const FRAMES = 24

/**
 * Measures the GPU time of each feature of a running scene: it is switched off for a while, and on again.
 *
 * Frames with all are measured before and after each, so that a scene that slowly changes, or a GPU that changes its
 * clock, falsifies nothing.
 */
export class FeatureMeter<Off> {
  /** Shares found so far, in the order of the features. */
  readonly shares: FeatureShare[] = []
  readonly #switchTo: (off: Off | undefined) => void
  #features: readonly MeteredFeature<Off>[] = []
  /** Half-steps: even ones have all features, odd ones lack one. */
  #step = 0
  #seconds = 0
  #frames = 0
  /** GPU time of frames that were read, and their number. */
  #sum = 0
  #count = 0
  #isOff = false
  /** GPU time with all features, before the one that is off, and without it [ms]. */
  #before = 0
  #without = 0

  /** @param switchTo - Switches a feature off, or all on that was off. */
  constructor(switchTo: (off: Off | undefined) => void) {
    this.#switchTo = switchTo
  }

  get isMeasuring(): boolean {
    return this.#features.length > 0
  }

  /** Feature that is measured now. */
  get current(): string | undefined {
    return this.#features[Math.min(this.#step >> 1, this.#features.length - 1)]?.name
  }

  /** Begins anew. */
  start(features: readonly MeteredFeature<Off>[]): void {
    this.stop()
    this.shares.length = 0
    this.#features = features
    this.#step = 0
    this.#wait()
  }

  /** Ends at once, with all switched on again; shares found so far stay. */
  stop(): void {
    this.#features = []
    this.#step = 0
    if (this.#isOff) this.#switch(undefined)
  }

  /** Counts a frame that was drawn, and the time since the last one [s]. */
  update(seconds: number): void {
    if (!this.isMeasuring) return
    this.#seconds += seconds
    this.#frames++
    const isOver = this.#seconds >= SETTLING + MEASURING && this.#count >= FRAMES
    if (isOver) this.#next(this.#sum / this.#count)
  }

  /** Takes the GPU time of some late frames together [ms]. */
  take(milliseconds: number, frames: number): void {
    if (!this.isMeasuring) return
    if (this.#seconds < SETTLING || this.#frames < SETTLING_FRAMES) return
    this.#sum += milliseconds
    this.#count += frames
  }

  #switch(off: Off | undefined): void {
    this.#isOff = off !== undefined
    this.#switchTo(off)
  }

  #wait(): void {
    this.#seconds = this.#frames = 0
    this.#sum = this.#count = 0
  }

  #next(milliseconds: number): void {
    const step = this.#step++
    if (step % 2 === 1) {
      this.#without = milliseconds
      this.#switch(undefined)
    } else {
      if (step > 0) {
        const all = (this.#before + milliseconds) / 2
        const { name } = this.#features[step / 2 - 1]
        this.shares.push({ name, milliseconds: all - this.#without })
      }
      this.#before = milliseconds
      const feature = this.#features[step / 2]
      if (feature === undefined) {
        this.stop()
        return
      }
      this.#switch(feature.off)
    }
    this.#wait()
  }
}
