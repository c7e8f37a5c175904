/** Milliseconds of a day. */
const DAY = 86_400_000

const dayNumber = (date: number): number => Math.floor(date / DAY)

/** Clock of a scene. */
interface Clock {
  /** Moment [ms since 1970]. */
  readonly time: number
  /** Solar time [h]. */
  readonly hour: number
}

/** Day, UTC, whose noon is in the solar day of a clock, at midnight [ms since 1970]. */
export function dateOfClock({ time, hour }: Clock): number {
  const midnight = time / DAY - hour / 24
  // Rounding puts no noon on the day before.
  return Math.ceil(midnight - 0.5 - 1e-7) * DAY
}

/** Time by which a clock is to move to be at a date's day, at its hour [ms]. */
export const wayTo = (date: number, clock: Clock): number =>
  DAY * (dayNumber(date) - dayNumber(dateOfClock(clock)))

/** Date of a running clock in a story's controls, and so in the address; one that is set there by hand is told from it. */
export class ShownDate {
  #shown: number
  #date: number

  /** @param date - A moment of the day in the controls [ms since 1970]. */
  constructor(date: number) {
    this.#shown = this.#date = date
  }

  /** A moment of the day that the scene is to have: of the last one set by hand, or the clock's [ms since 1970]. */
  get date(): number {
    return this.#date
  }

  /** Date that the controls are to show now; undefined while they have that day. */
  next(clock: Clock): number | undefined {
    const date = dateOfClock(clock)
    if (dayNumber(date) === dayNumber(this.#shown)) return undefined
    return (this.#shown = date)
  }

  /**
   * Takes the date that the controls have after any of them has changed.
   *
   * @param before - Date that they had.
   * @returns True if it was set by hand: the clock goes on from there.
   */
  take(date: number, before: number, clock: Clock): boolean {
    const isSet = date !== before && date !== this.#shown
    if (isSet) this.#shown = date
    const now = dateOfClock(clock)
    this.#date = isSet || dayNumber(date) === dayNumber(now) ? date : now
    return isSet
  }
}
