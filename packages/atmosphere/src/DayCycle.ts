import type { Camera } from 'three'
import { Vector3 } from 'three'
import { Geodetic } from '@welkin/geo'
import type { Atmosphere } from './Atmosphere'
import { exposureFor, type ExposureOptions } from './exposureFor'

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
  exposure?: ExposureOptions
}

const DAY = 86_400_000
const YEAR = 365.2422 * DAY

/** An equinox of March; later ones come every {@link YEAR} [ms since 1970]. */
const EQUINOX = Date.UTC(2026, 2, 20, 14, 46)

const _origin = new Vector3()
const _geodetic = new Geodetic()

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
 * It drives `atmosphere.date`, which whatever is in the sky follows. `time`, one number, is all of its
 * state.
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

  /** @throws If an argument is of the wrong kind or out of range. */
  constructor(atmosphere: Atmosphere, options: DayCycleOptions = {}) {
    if (!atmosphere?.isAtmosphere) {
      throw new Error(`DayCycle: atmosphere must be an Atmosphere, got ${typeof atmosphere}`)
    }
    this.atmosphere = atmosphere
    const { date, rate, daylight, adaptation, holdDay = false, exposure = {} } = options
    this.exposureOptions = exposure
    this.holdDay = holdDay
    if (rate !== undefined) this.rate = rate
    if (daylight !== undefined) this.daylight = daylight
    if (adaptation !== undefined) this.adaptation = adaptation
    this.#daylightScale = atmosphere.luminanceScale
    this.#time = 0
    this.time = (date ?? atmosphere.date ?? new Date()).getTime()
  }

  /** When it is in the sky [ms since 1970]. The cycle's whole state. */
  get time(): number {
    return this.#time
  }

  set time(value: number) {
    // Beyond this there are no dates.
    if (!(Math.abs(value) <= 8.64e15)) {
      throw new Error(`DayCycle: time must be a date in milliseconds, got ${value}`)
    }
    this.#time = value
    this.atmosphere.date = new Date(value)
  }

  /** Seconds of the sky per second of the clock. */
  get rate(): number {
    return this.#rate
  }

  set rate(value: number) {
    if (!Number.isFinite(value)) throw new Error(`DayCycle: rate must be finite, got ${value}`)
    this.#rate = value
  }

  /** Part of a turn of the clock that day takes, in (0, 1): more than 0.5 makes days long, nights short. */
  get daylight(): number {
    return this.#daylight
  }

  set daylight(value: number) {
    if (!(value > 0 && value < 1)) {
      throw new Error(`DayCycle: daylight must be in (0, 1), got ${value}`)
    }
    this.#daylight = value
  }

  /** Time in which exposure follows the light to 63 % [s]. */
  get adaptation(): number {
    return this.#adaptation
  }

  set adaptation(value: number) {
    if (!(value >= 0 && value < Infinity)) {
      throw new Error(`DayCycle: adaptation must be finite and ≥ 0, got ${value}`)
    }
    this.#adaptation = value
  }

  /** Geodetic latitude of the world's origin [°]; setting it keeps longitude and height. */
  get latitude(): number {
    return this.#place().latitude
  }

  set latitude(value: number) {
    const { longitude, height } = this.#place()
    this.atmosphere.place({ longitude, latitude: value, height })
  }

  /** Part of the year since the equinox of March, in [0, 1); setting it keeps the time of day. */
  get season(): number {
    return wrap((this.#time - EQUINOX) / YEAR, 1)
  }

  set season(value: number) {
    if (!Number.isFinite(value)) throw new Error(`DayCycle: season must be finite, got ${value}`)
    const days = Math.round(((wrap(value, 1) - this.season) * YEAR) / DAY)
    this.time = this.#time + days * DAY
  }

  /** Mean solar time at the world's origin, in [0, 24); setting it keeps the day [h]. */
  get hour(): number {
    return this.#dayPart() * 24
  }

  set hour(value: number) {
    if (!(value >= 0 && value < 24)) {
      throw new Error(`DayCycle: hour must be in [0, 24), got ${value}`)
    }
    this.time = this.#time + (value / 24 - this.#dayPart()) * DAY
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

  #dayPart(): number {
    return wrap(this.#time / DAY + this.#place().longitude / 360, 1)
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
      throw new Error(`DayCycle: deltaSeconds must be finite, got ${deltaSeconds}`)
    }
    if (!this.paused) this.time = this.#time + this.#advance(deltaSeconds * this.#rate * 1000)
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
    this.atmosphere.luminanceScale = this.#daylightScale * this.#exposure
  }
}
