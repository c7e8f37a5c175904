import type { Camera } from 'three'
import { Matrix4, Vector3 } from 'three'
import { checkDate, checkNonNegative, checkOptions, fail, Geodetic } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkRange } from '../check'
import { checkExposure, exposureFor, type ExposureOptions } from './exposureFor'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link DayCycle}. */
export interface DayCycleOptions {
  /** When it begins; by default the atmosphere's date or, if it has none, now. */
  date?: Date
  /** Seconds of the sky per second of the clock; negative runs backwards. Default 1440: a day a minute. */
  rate?: number
  /** Part of a turn of the clock that day takes, 6 to 18 h of solar time, in (0, 1). Default 0.5. */
  daylight?: number
  /** Whether the calendar stays on the day that it is on. Default false. */
  holdDay?: boolean
  /** Time in which exposure follows the light to 63 %, ≥ 0; 0 follows at once [s]. Default 0.3. */
  adaptation?: number
  /** Options of `exposureFor`. */
  exposureOptions?: ExposureOptions
}

const DAY = 86_400_000

/** Days of a year. */
const YEAR = 365.2422

/** An equinox of March; later ones come every {@link YEAR} [ms since 1970]. */
const EQUINOX = Date.UTC(2026, 2, 20, 14, 46)

/** A tenth of a millisecond, lest rounding makes midnight the day before [days]. */
const MOMENT = 1e-9

const _origin = new Vector3()
const _geodetic = new Geodetic()
const _frame = new Matrix4()
const _scale = new Vector3()

/** The `luminanceScale` that a cycle last set on an atmosphere, and that of exposure 1. */
const scales = new WeakMap<Atmosphere, { written: number; daylight: number }>()

const wrap = (value: number, period: number): number => value - Math.floor(value / period) * period

/**
 * A clock that moves sun, moon and stars, and the exposure after them.
 *
 * ```ts
 * const cycle = new DayCycle(atmosphere, { rate: 1440 })
 * // per frame
 * cycle.update(deltaSeconds, camera)
 * // to keep and to come back
 * localStorage.time = cycle.time
 * cycle.time = Number(localStorage.time)
 * ```
 *
 * It drives `atmosphere.date`, which whatever is in the sky follows. `time`, one number, is where the
 * clock stands; the rest is settings and the atmosphere's place.
 *
 * Exposure multiplies the `luminanceScale` that the atmosphere has when the cycle is made, unless that is
 * what another cycle wrote: from that it takes over.
 */
export class DayCycle {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Whether {@link update} leaves the clock alone; exposure still follows. */
  paused = false
  /** Whether the calendar stays on its day: the season, and the moon, go round and round. */
  holdDay: boolean
  /** Options of `exposureFor`. */
  readonly exposureOptions: ExposureOptions
  #time: number
  #rate = 1440
  #daylight = 0.5
  #adaptation = 0.3
  #exposure: number | null = null
  /** Of exposure 1 [1/(cd/m²)]. */
  readonly #daylightScale: number
  /** The season that was set and the day that it was set to; null if the time was set since. */
  #asked: { season: number; day: number } | null = null

  /** @throws If an argument is of the wrong kind or out of range. */
  constructor(atmosphere: Atmosphere, options: DayCycleOptions = {}) {
    checkAtmosphere('DayCycle', atmosphere)
    const { date, rate, daylight, adaptation, holdDay, exposureOptions } = checkOptions(
      'DayCycle',
      options,
      'date',
      'rate',
      'daylight',
      'holdDay',
      'adaptation',
      'exposureOptions'
    )
    this.atmosphere = atmosphere
    this.exposureOptions = checkExposure('DayCycle', exposureOptions)
    this.holdDay = holdDay ?? false
    if (rate !== undefined) this.rate = rate
    if (daylight !== undefined) this.daylight = daylight
    if (adaptation !== undefined) this.adaptation = adaptation
    const { luminanceScale } = atmosphere
    const known = scales.get(atmosphere)
    this.#daylightScale = known?.written === luminanceScale ? known.daylight : luminanceScale
    this.#time = 0
    this.date = date ?? atmosphere.date ?? new Date()
  }

  /** When it is in the sky [ms since 1970]. */
  get time(): number {
    return this.#time
  }

  set time(value: number) {
    this.#moveTo(value)
    this.#asked = null
  }

  /** The same as a date, a copy. */
  get date(): Date {
    return new Date(this.#time)
  }

  set date(value: Date) {
    checkDate('DayCycle', value)
    this.time = value.getTime()
  }

  #moveTo(time: number): void {
    // Beyond this there are no dates.
    if (!(Number.isFinite(time) && Math.abs(time) <= 8.64e15)) {
      fail('DayCycle', 'time must be a date in milliseconds', time)
    }
    this.#time = time
    this.atmosphere.date = new Date(time)
  }

  /** Seconds of the sky per second of the clock. */
  get rate(): number {
    return this.#rate
  }

  set rate(value: number) {
    if (!Number.isFinite(value)) fail('DayCycle', 'rate must be finite', value)
    this.#rate = value
  }

  /** Part of a turn of the clock that day takes, in (0, 1): more than 0.5 makes days long, nights short. */
  get daylight(): number {
    return this.#daylight
  }

  set daylight(value: number) {
    if (!(Number.isFinite(value) && value > 0 && value < 1)) {
      fail('DayCycle', 'daylight must be in (0, 1)', value)
    }
    this.#daylight = value
  }

  /** Time in which exposure follows the light to 63 % [s]. */
  get adaptation(): number {
    return this.#adaptation
  }

  set adaptation(value: number) {
    checkNonNegative('DayCycle', 'adaptation', value)
    this.#adaptation = value
  }

  /**
   * Geodetic latitude of the world's origin [°]; setting it keeps longitude and height.
   *
   * @throws If it is set out of range, or in a frame that `atmosphere.place` did not make.
   */
  get latitude(): number {
    return this.#place().latitude
  }

  set latitude(value: number) {
    checkRange('DayCycle', 'latitude', value, -90, 90)
    const { frame, metersPerUnit, worldToECEF, ellipsoid } = this.atmosphere
    if (frame !== 'local') fail('DayCycle', "frame must be 'local' to set latitude", frame)
    const { longitude, height } = this.#place()
    ellipsoid.localYUpFrame(_origin, _frame).scale(_scale.setScalar(metersPerUnit))
    if (!_frame.equals(worldToECEF)) {
      fail('DayCycle', 'frame must be of place() to set latitude', 'worldToECEF')
    }
    this.atmosphere.place({ longitude, latitude: value, height })
  }

  /**
   * Part of the year since the equinox of March, in [0, 1), the same all day. Setting it goes to the
   * nearest day, at the time of day that it is.
   */
  get season(): number {
    const { season, day } = this.#asked ?? { season: 0, day: this.#dayOf(EQUINOX) }
    return wrap(season + (this.#dayOf(this.#time) - day) / YEAR, 1)
  }

  set season(value: number) {
    if (!Number.isFinite(value)) fail('DayCycle', 'season must be finite', value)
    const season = wrap(value, 1)
    const last = this.season
    // What the day last set to was off by.
    const off = (last - (this.#dayOf(this.#time) - this.#dayOf(EQUINOX)) / YEAR) % 1
    const days = Math.round((season - last + off - Math.round(off)) * YEAR)
    this.#moveTo(this.#time + days * DAY)
    this.#asked = { season, day: this.#dayOf(this.#time) }
  }

  /** Mean solar time at the world's origin, in [0, 24); setting it keeps the day [h]. */
  get hour(): number {
    return this.#dayPart() * 24
  }

  set hour(value: number) {
    if (!(Number.isFinite(value) && value >= 0 && value < 24)) {
      fail('DayCycle', 'hour must be in [0, 24)', value)
    }
    this.#moveTo(this.#time + (value / 24 - this.#dayPart()) * DAY)
  }

  /** What {@link update} last set: 1 in full daylight. */
  get exposure(): number {
    return this.#exposure ?? 1
  }

  /** In the ECEF frame the origin is the planet's centre: then it is Greenwich's time that counts. */
  #place(): Geodetic {
    const { worldToECEF, ellipsoid } = this.atmosphere
    _origin.setFromMatrixPosition(worldToECEF)
    if (_origin.length() < ellipsoid.radii.x / 2) return _geodetic.set(0, 0, 0)
    return ellipsoid.ecefToGeodetic(_origin, _geodetic)
  }

  /** Solar days since 1970. */
  #days(time: number): number {
    return time / DAY + this.#place().longitude / 360
  }

  /** Number of the solar day. */
  #dayOf(time: number): number {
    return Math.floor(this.#days(time) + MOMENT)
  }

  #dayPart(): number {
    return Math.max(this.#days(this.#time) - this.#dayOf(this.#time), 0)
  }

  /**
   * Moves the clock on.
   *
   * @param deltaSeconds - Since the last call [s].
   * @param camera - Sets `atmosphere.luminanceScale` to follow what it sees; leave it out to keep that.
   * @throws If the time is not finite.
   */
  update(deltaSeconds: number, camera?: Camera): void {
    if (!Number.isFinite(deltaSeconds)) {
      fail('DayCycle.update', 'deltaSeconds must be finite', deltaSeconds)
    }
    if (!this.paused) this.#moveTo(this.#time + this.#advance(deltaSeconds * this.#rate * 1000))
    if (camera !== undefined) this.#adapt(deltaSeconds, camera)
  }

  /** How far the sky moves while an even clock moves [ms]: clock and sky agree at 6 and at 18 h. */
  #advance(clock: number): number {
    const start = this.#dayPart()
    const end = this.#skyPart(this.#clockPart(start) + clock / DAY)
    const days = end - start
    return (this.holdDay ? wrap(end, 1) - start : days) * DAY
  }

  /** Part of the day on an even clock: its middle half, of solar time, takes `daylight` of it. */
  #clockPart(sky: number): number {
    const [whole, part] = [Math.floor(sky), wrap(sky, 1)]
    const [day, night] = [this.#daylight * 2, (1 - this.#daylight) * 2]
    if (part < 0.25) return whole + part * night
    if (part < 0.75) return whole + 0.25 * night + (part - 0.25) * day
    return whole + 1 - (1 - part) * night
  }

  #skyPart(clock: number): number {
    const [whole, part] = [Math.floor(clock), wrap(clock, 1)]
    const [day, night] = [this.#daylight * 2, (1 - this.#daylight) * 2]
    const morning = 0.25 * night
    if (part < morning) return whole + part / night
    if (part < 1 - morning) return whole + 0.25 + (part - morning) / day
    return whole + 1 - (1 - part) / night
  }

  #adapt(deltaSeconds: number, camera: Camera): void {
    const target = exposureFor(this.atmosphere, camera, this.exposureOptions)
    const last = this.#exposure ?? target
    // In stops, as eyes and cameras count.
    const rest = this.#adaptation > 0 ? Math.exp(-Math.abs(deltaSeconds) / this.#adaptation) : 0
    this.#exposure = target * (last / target) ** rest
    const written = this.#daylightScale * this.#exposure
    this.atmosphere.luminanceScale = written
    scales.set(this.atmosphere, { written, daylight: this.#daylightScale })
  }
}
