/** Milliseconds of a day. */
export const DAY = 86_400_000

/** Days of a year. */
export const YEAR = 365.2422

/** A March equinox; later ones follow every {@link YEAR} [ms since 1970]. */
export const MARCH_EQUINOX = /*#__PURE__*/ Date.UTC(2026, 2, 20, 14, 46)

/** A tenth of a millisecond, so that rounding does not put midnight on the day before [days]. */
const ROUNDING = 1e-9

/** Remainder in [0, period). */
export const wrap = (value: number, period: number): number =>
  value - Math.floor(value / period) * period

/** Mean solar time in days since 1970, at a longitude. */
const solarDays = (time: number, longitudeDegrees: number): number =>
  time / DAY + longitudeDegrees / 360

/** Number of the solar day since 1970. */
export const solarDayNumber = (time: number, longitudeDegrees: number): number =>
  Math.floor(solarDays(time, longitudeDegrees) + ROUNDING)

/** Fraction of the solar day that has passed, in [0, 1). */
export const solarDayFraction = (time: number, longitudeDegrees: number): number =>
  Math.max(solarDays(time, longitudeDegrees) - solarDayNumber(time, longitudeDegrees), 0)

/**
 * Clock on which daytime, 6 to 18 h of solar time, takes the fraction `daylight` of a day. Clock and solar
 * time agree at midnight and noon.
 *
 * @param solar - Solar time [days].
 * @returns Time of the clock [days].
 */
export function clockOfSolar(solar: number, daylight: number): number {
  const [whole, part] = [Math.floor(solar), wrap(solar, 1)]
  const [day, night] = [daylight * 2, (1 - daylight) * 2]
  if (part < 0.25) return whole + part * night
  if (part < 0.75) return whole + 0.25 * night + (part - 0.25) * day
  return whole + 1 - (1 - part) * night
}

/** Inverse of {@link clockOfSolar}. */
export function solarOfClock(clock: number, daylight: number): number {
  const [whole, part] = [Math.floor(clock), wrap(clock, 1)]
  const [day, night] = [daylight * 2, (1 - daylight) * 2]
  const morning = 0.25 * night
  if (part < morning) return whole + part / night
  if (part < 1 - morning) return whole + 0.25 + (part - morning) / day
  return whole + 1 - (1 - part) / night
}
