/** Time between two showings of the hour in the controls, and so in the address [ms]. */
const INTERVAL = 3000

/** Hundredths of an hour that have passed, in which the sun moves by 0.15° [h]. */
export const toHundredths = (hour: number): number => Math.floor(100 * hour + 1e-9) / 100

/** Hour of a running clock in a story's controls, and so in the address; one that is set there by hand is told from it. */
export class ShownHour {
  #shown: number
  #byHand: number
  /** Moment of the last showing, or of the last change by hand [ms]. */
  #last = -Infinity
  readonly #now: () => number

  /** @param now - Clock, in milliseconds; by default the page's. */
  constructor(hour: number, now: () => number = () => performance.now()) {
    this.#shown = this.#byHand = hour
    this.#now = now
    this.#last = now()
  }

  /** Hour that was last set by hand [h]. */
  get byHand(): number {
    return this.#byHand
  }

  /** Hour that the controls are to show now, a hundredth or less before the clock's [h]; undefined most of the time. */
  next(hour: number): number | undefined {
    if (this.#now() - this.#last < INTERVAL) return undefined
    this.#last = this.#now()
    return (this.#shown = toHundredths(hour))
  }

  /**
   * Takes the hour that the controls have after any of them has changed.
   *
   * @param before - Hour that they had.
   * @returns True if it was set by hand: the clock goes on from there.
   */
  take(hour: number, before: number): boolean {
    const isSet = hour !== before && hour !== this.#shown
    if (isSet) this.#byHand = hour
    // Whoever changes things is not interrupted.
    if (isSet || hour === before) this.#last = this.#now()
    return isSet
  }
}
