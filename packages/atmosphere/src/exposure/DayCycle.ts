import type { Camera } from 'three'
import { Matrix4, Vector3 } from 'three'
import {
  checkBoolean,
  checkDate,
  checkNonNegative,
  checkOptions,
  fail,
  Geodetic,
  setOptions
} from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import { checkRange } from '../check'
import type { AutoExposureNode } from './AutoExposureNode'
import { ExposureAdaptation } from './ExposureAdaptation'
import { checkExposure, type ExposureOptions } from './exposureFor'
import {
  clockOfSolar,
  DAY,
  MARCH_EQUINOX,
  solarDayFraction,
  solarDayNumber,
  solarOfClock,
  wrap,
  YEAR
} from './solarTime'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link DayCycle}. */
export interface DayCycleOptions {
  /** Date at the start; by default the atmosphere's date, or now if it has none. */
  date?: Date
  /** Solar time per time of the clock; negative runs backwards. Default 1440: a day per minute. */
  rate?: number
  /** Fraction of a cycle that daytime (6 to 18 h of solar time) takes, in (0, 1). Default 0.5. */
  daylight?: number
  /** Repeats the same day, so that season and moon stay. Default false. */
  holdDay?: boolean
  /** Stops the clock; exposure still adapts. Default false. */
  paused?: boolean
  /** Time in which exposure adapts by 63 %, ≥ 0; 0 adapts at once [s]. Default 0.3. */
  adaptation?: number
  /** Options of `exposureFor`; by default its own. */
  exposureOptions?: ExposureOptions
  /** Exposure by what the camera sees, in place of `exposureFor`; by default null. Shared, not owned. */
  autoExposure?: AutoExposureNode | null
}

const SETTINGS = ['rate', 'daylight', 'holdDay', 'paused', 'adaptation'] as const

const _origin = new Vector3()
const _geodetic = new Geodetic()
const _frame = new Matrix4()
const _scale = new Vector3()

/**
 * Clock that moves sun, moon and stars, and adapts the exposure to their light.
 *
 * ```ts
 * const exposure = autoExposure(pass(scene, camera), atmosphere)
 * pipeline.outputNode = exposure
 * const cycle = new DayCycle(atmosphere, { rate: 1440, autoExposure: exposure })
 * // per frame
 * cycle.update(deltaSeconds)
 * pipeline.render()
 * // to keep and to come back
 * localStorage.time = cycle.time
 * cycle.time = Number(localStorage.time)
 * ```
 *
 * It sets `atmosphere.date`, which everything in the sky follows. `time`, one number, is the state of the
 * clock; the rest is settings and the atmosphere's place.
 *
 * With `autoExposure` the picture sets `luminanceScale`, and that has options of its own. Without, `cycle.update(deltaSeconds,
 * camera)` takes `exposureFor`, which multiplies the `luminanceScale` that the atmosphere has when the cycle is made, unless
 * another cycle wrote that: from that it takes over.
 */
export class DayCycle {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** Options of `exposureFor`. */
  readonly exposureOptions: ExposureOptions
  /** Exposure by what the camera sees, in place of `exposureFor`, or null. Shared, not owned. */
  readonly autoExposure: AutoExposureNode | null
  #time: number
  #rate = 1440
  #daylight = 0.5
  #holdDay = false
  #paused = false
  #adaptation = 0.3
  readonly #exposureAdaptation: ExposureAdaptation
  /** Season that was set, and the solar day that it led to; null if the time was set since. */
  #requestedSeason: { season: number; day: number } | null = null

  /** @throws If an argument is of the wrong kind or out of range. */
  constructor(atmosphere: Atmosphere, options: DayCycleOptions = {}) {
    checkAtmosphere('DayCycle', atmosphere)
    const {
      date,
      exposureOptions,
      autoExposure = null,
      ...settings
    } = checkOptions('DayCycle', options, 'date', 'exposureOptions', 'autoExposure', ...SETTINGS)
    if (autoExposure !== null && autoExposure?.atmosphere !== atmosphere) {
      fail('DayCycle', 'autoExposure must be an autoExposure() of its atmosphere', autoExposure)
    }
    this.atmosphere = atmosphere
    this.autoExposure = autoExposure
    this.exposureOptions = checkExposure('DayCycle', exposureOptions)
    this.set(settings)
    this.#exposureAdaptation = new ExposureAdaptation(atmosphere)
    this.#time = 0
    this.date = date ?? atmosphere.date ?? new Date()
  }

  /**
   * Changes some settings. Date and place are no settings, but the state of the clock and the atmosphere's.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Pick<DayCycleOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('DayCycle', this, settings, ...SETTINGS)
  }

  /** Time that sun, moon and stars are drawn for [ms since 1970]. */
  get time(): number {
    return this.#time
  }

  set time(value: number) {
    this.#moveTo(value)
    this.#requestedSeason = null
  }

  /** Time as a date, a copy. */
  get date(): Date {
    return new Date(this.#time)
  }

  set date(value: Date) {
    checkDate('DayCycle', value)
    this.time = value.getTime()
  }

  #moveTo(time: number): void {
    // The largest time that a Date can hold.
    if (!(Number.isFinite(time) && Math.abs(time) <= 8.64e15)) {
      fail('DayCycle', 'time must be a date in milliseconds', time)
    }
    this.#time = time
    this.atmosphere.date = new Date(time)
  }

  /** Solar time per time of the clock. */
  get rate(): number {
    return this.#rate
  }

  set rate(value: number) {
    if (!Number.isFinite(value)) fail('DayCycle', 'rate must be finite', value)
    this.#rate = value
  }

  /** Fraction of a cycle that daytime takes, in (0, 1): above 0.5 days are long and nights short. */
  get daylight(): number {
    return this.#daylight
  }

  set daylight(value: number) {
    if (!(Number.isFinite(value) && value > 0 && value < 1)) {
      fail('DayCycle', 'daylight must be in (0, 1)', value)
    }
    this.#daylight = value
  }

  /** Repeats the same day, so that season and moon stay. */
  get holdDay(): boolean {
    return this.#holdDay
  }

  set holdDay(value: boolean) {
    checkBoolean('DayCycle', 'holdDay', value)
    this.#holdDay = value
  }

  /** Stops the clock; exposure still adapts. */
  get paused(): boolean {
    return this.#paused
  }

  set paused(value: boolean) {
    checkBoolean('DayCycle', 'paused', value)
    this.#paused = value
  }

  /** Time in which exposure adapts by 63 % [s]. */
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
    return this.#originGeodetic().latitude
  }

  set latitude(value: number) {
    checkRange('DayCycle', 'latitude', value, -90, 90)
    const { frame, metersPerUnit, worldToECEF, ellipsoid } = this.atmosphere
    if (frame !== 'local') fail('DayCycle', "frame must be 'local' to set latitude", frame)
    const { longitude, height } = this.#originGeodetic()
    ellipsoid.localYUpFrame(_origin, _frame).scale(_scale.setScalar(metersPerUnit))
    if (!_frame.equals(worldToECEF)) {
      fail('DayCycle', 'frame must be of place() to set latitude', 'worldToECEF')
    }
    this.atmosphere.place({ longitude, latitude: value, height })
  }

  /**
   * Fraction of the year since the March equinox, in [0, 1), constant all day. Setting it goes to the
   * nearest day of that season and keeps the hour.
   */
  get season(): number {
    const { season, day } = this.#requestedSeason ?? {
      season: 0,
      day: this.#solarDay(MARCH_EQUINOX)
    }
    return wrap(season + (this.#solarDay(this.#time) - day) / YEAR, 1)
  }

  set season(value: number) {
    if (!Number.isFinite(value)) fail('DayCycle', 'season must be finite', value)
    const season = wrap(value, 1)
    const last = this.season
    // Rounding error of the season last set, in years.
    const error = (last - (this.#solarDay(this.#time) - this.#solarDay(MARCH_EQUINOX)) / YEAR) % 1
    const days = Math.round((season - last + error - Math.round(error)) * YEAR)
    this.#moveTo(this.#time + days * DAY)
    this.#requestedSeason = { season, day: this.#solarDay(this.#time) }
  }

  /** Mean solar time at the world's origin, in [0, 24); setting it keeps the day [h]. */
  get hour(): number {
    return this.#dayFraction() * 24
  }

  set hour(value: number) {
    if (!(Number.isFinite(value) && value >= 0 && value < 24)) {
      fail('DayCycle', 'hour must be in [0, 24)', value)
    }
    this.#moveTo(this.#time + (value / 24 - this.#dayFraction()) * DAY)
  }

  /** Exposure last set by {@link update}: 1 in full daylight, with `autoExposure` 0.3 or so. */
  get exposure(): number {
    const { daylightScale, exposure } = this.#exposureAdaptation
    return this.autoExposure ? this.atmosphere.luminanceScale / daylightScale : exposure
  }

  /** Geodetic position of the world's origin; longitude 0 where that is the planet's centre. */
  #originGeodetic(): Geodetic {
    const { worldToECEF, ellipsoid } = this.atmosphere
    _origin.setFromMatrixPosition(worldToECEF)
    if (_origin.length() < ellipsoid.radii.x / 2) return _geodetic.set(0, 0, 0)
    return ellipsoid.ecefToGeodetic(_origin, _geodetic)
  }

  #solarDay(time: number): number {
    return solarDayNumber(time, this.#originGeodetic().longitude)
  }

  #dayFraction(): number {
    return solarDayFraction(this.#time, this.#originGeodetic().longitude)
  }

  /**
   * Advances the clock.
   *
   * @param deltaSeconds - Time since the last call [s].
   * @param camera - Camera that `atmosphere.luminanceScale` adapts to; without one it stays, unless there is an
   *   `autoExposure`, which needs none.
   * @throws If the time is not finite.
   */
  update(deltaSeconds: number, camera?: Camera): void {
    if (!Number.isFinite(deltaSeconds)) {
      fail('DayCycle.update', 'deltaSeconds must be finite', deltaSeconds)
    }
    if (!this.paused) this.#moveTo(this.#time + this.#solarTimeOf(deltaSeconds * this.#rate * 1000))
    if (this.autoExposure) {
      this.autoExposure.adapt(Math.abs(deltaSeconds))
    } else if (camera !== undefined) {
      this.#exposureAdaptation.update(camera, this.exposureOptions, deltaSeconds, this.#adaptation)
    }
  }

  /** Solar time that passes while the clock moves by some time [ms]. */
  #solarTimeOf(clockTime: number): number {
    const start = this.#dayFraction()
    const clock = clockOfSolar(start, this.#daylight) + clockTime / DAY
    const end = solarOfClock(clock, this.#daylight)
    return (this.holdDay ? wrap(end, 1) - start : end - start) * DAY
  }
}
