/** Solar time in which the sun goes a 25th of its width [s]. */
const STEP = 5

/** Clock that goes in steps that no one sees: what follows the sun, such as tables of the air, is not made anew in each frame. */
export class StepClock {
  /** Time that the sun has not gone yet [s]. */
  #waiting = 0

  /**
   * Rate at which the sun goes on in the next frame, 0 in most: no time is lost over them.
   *
   * @param seconds - Time since the last frame [s].
   * @param rate - Solar time per time of the clock; 0 where it is stopped.
   */
  rateNow(seconds: number, rate: number): number {
    this.#waiting = rate === 0 ? 0 : this.#waiting + seconds
    if (seconds === 0 || this.#waiting * rate < STEP) return 0
    const now = (rate * this.#waiting) / seconds
    this.#waiting = 0
    return now
  }
}
