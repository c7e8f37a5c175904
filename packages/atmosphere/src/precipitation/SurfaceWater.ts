import { checkFinite, checkNonNegative, checkOptions, checkPositive, setOptions } from '@welkin/geo'
import type { UniformNode } from 'three/webgpu'
import { checkRange } from '../check'
import { number } from '../uniforms'
import { numberBetween, raindropSizes } from './cpu/sizes'
import {
  evaporation,
  NEW_SNOW,
  settledDensity,
  snowCoverFraction,
  snowmelt,
  wetFraction
} from './cpu/surfaceWater'

/** Weather that a surface is in, for {@link SurfaceWater.update}. */
export interface SurfaceWeather {
  /** Rate of rain [mm/h]; by default 0. */
  rain?: number
  /** Rate of snow, as water [mm/h]; by default 0. */
  snow?: number
  /** Temperature of the air [°C]; by default 10. */
  temperature?: number
  /** Relative humidity of the air, in [0, 1] [–]; by default 0.7. */
  humidity?: number
  /** Speed of the wind at 2 m [m/s]; by default 2. */
  wind?: number
  /** Irradiance of the ground by sun and sky [W/m²]; by default 0. Lux over 110 is a good guess. */
  irradiance?: number
}

/** Options of {@link SurfaceWater}. */
export interface SurfaceWaterOptions {
  /** See {@link SurfaceWater.filmCapacity}; by default 0.5. */
  filmCapacity?: number
  /** See {@link SurfaceWater.puddleCapacity}; by default 2. */
  puddleCapacity?: number
}

const NAME = 'SurfaceWater'
const SETTINGS = ['filmCapacity', 'puddleCapacity'] as const
const WEATHER = ['rain', 'snow', 'temperature', 'humidity', 'wind', 'irradiance'] as const
/** Longest step of the balance [h]. */
const STEP = 1 / 60
/** Share of sunlight that wet ground absorbs [–]. */
const ABSORBED = 0.9
/** Drops that make rings which are seen [mm], and their mean speed of fall [m/s]. */
const RING_DROP = 2.5
const RING_DROP_SPEED = 7.7

/**
 * Water and snow that weather leaves on surfaces: rises with rain and snow, dries with sun and wind.
 *
 * ```ts
 * const water = new SurfaceWater()
 * Object.assign(road, wetSurface(water)) // a MeshStandardNodeMaterial
 * water.update(seconds, { rain: 12, temperature: 8, wind: 3, irradiance: 60 }) // each frame
 * water.wetness // as a number; wetnessNode for shaders
 * ```
 *
 * It balances rain, melt, evaporation (Penman 1948) and runoff of one surface under the open sky. A film fills first, then puddles; what they
 * cannot hold runs off. Snow settles, and melts by air and sun; rain and melt run through it.
 */
export class SurfaceWater {
  /** {@link wetness} for shaders, in [0, 1] [–]. */
  readonly wetnessNode: UniformNode<'float', number> = number()
  /** {@link puddles} for shaders, in [0, 1] [–]. */
  readonly puddlesNode: UniformNode<'float', number> = number()
  /** {@link snowCover} for shaders, in [0, 1] [–]. */
  readonly snowCoverNode: UniformNode<'float', number> = number()
  /** {@link ringRate} for shaders, ≥ 0 [1/(m² s)]. */
  readonly ringRateNode: UniformNode<'float', number> = number()
  #filmCapacity = 0.5
  #puddleCapacity = 2
  #water = 0
  #snow = 0
  #density = NEW_SNOW

  /** @throws If an option is unknown or out of range. */
  constructor(options: SurfaceWaterOptions = {}) {
    this.set(options)
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or refused; then nothing has changed.
   */
  set(settings: SurfaceWaterOptions): this {
    return setOptions(NAME, this, settings, ...SETTINGS)
  }

  /** Water that a film on the surface holds, > 0 [mm]: asphalt about 0.5, leaves 0.2. */
  get filmCapacity(): number {
    return this.#filmCapacity
  }

  set filmCapacity(value: number) {
    checkPositive(NAME, 'filmCapacity', value)
    this.#filmCapacity = value
    this.#show()
  }

  /** Water that its hollows hold besides, > 0 [mm]: paved ground 1 to 3. */
  get puddleCapacity(): number {
    return this.#puddleCapacity
  }

  set puddleCapacity(value: number) {
    checkPositive(NAME, 'puddleCapacity', value)
    this.#puddleCapacity = value
    this.#show()
  }

  /** Water on the surface, finite, ≥ 0 [mm]. */
  get water(): number {
    return this.#water
  }

  set water(value: number) {
    checkNonNegative(NAME, 'water', value)
    this.#water = value
    this.#show()
  }

  /** Snow on the surface, as water, finite, ≥ 0 [mm]: new snow lies ten times as deep. */
  get snow(): number {
    return this.#snow
  }

  set snow(value: number) {
    checkNonNegative(NAME, 'snow', value)
    this.#snow = value
    this.#show()
  }

  /** Share of the surface that is wet, in [0, 1] [–]. */
  get wetness(): number {
    return wetFraction(this.#water / this.#filmCapacity)
  }

  /** Share of the hollows that water fills, in [0, 1] [–]. */
  get puddles(): number {
    return Math.min(Math.max(this.#water - this.#filmCapacity, 0) / this.#puddleCapacity, 1)
  }

  /** Share of level ground that snow covers, in [0, 1) [–]. */
  get snowCover(): number {
    return snowCoverFraction(this.#snow, this.#density)
  }

  /** Depth of the snow [m]. */
  get snowDepth(): number {
    return this.#snow / this.#density
  }

  /** Drops that make rings on puddles, those over 2.5 mm wide, ≥ 0 [1/(m² s)]. */
  get ringRate(): number {
    return this.ringRateNode.value
  }

  /**
   * Advances by some time; days at once are fine.
   *
   * @param seconds - Finite, ≥ 0 [s].
   * @param weather - During that time.
   * @throws If a value is unknown or out of range; then nothing has changed.
   */
  update(seconds: number, weather: SurfaceWeather = {}): this {
    checkNonNegative(NAME, 'seconds', seconds)
    checkOptions(`${NAME}.weather`, weather, ...WEATHER)
    const { rain = 0, snow = 0, temperature = 10, humidity = 0.7 } = weather
    const { wind = 2, irradiance = 0 } = weather
    checkRange(NAME, 'rain', rain, 0, 300)
    checkRange(NAME, 'snow', snow, 0, 300)
    checkFinite(NAME, 'temperature', temperature)
    checkRange(NAME, 'temperature', temperature, -90, 60)
    checkRange(NAME, 'humidity', humidity, 0, 1)
    checkNonNegative(NAME, 'wind', wind)
    checkNonNegative(NAME, 'irradiance', irradiance)
    const drying = evaporation(temperature, humidity, wind, ABSORBED * irradiance)
    const melting = snowmelt(temperature, irradiance)
    const hours = seconds / 3600
    const steps = Math.max(Math.ceil(hours / STEP), 1)
    for (let i = 0; i < steps; i++) this.#step(hours / steps, rain, snow, drying, melting)
    this.ringRateNode.value =
      rain > 0 ? numberBetween(raindropSizes(rain), RING_DROP, Infinity) * RING_DROP_SPEED : 0
    this.#show()
    return this
  }

  #step(hours: number, rain: number, snow: number, drying: number, melting: number): void {
    const fallen = snow * hours
    const depth = this.#snow / settledDensity(this.#density, hours) + fallen / NEW_SNOW
    const lying = this.#snow + fallen
    this.#density = depth > 0 ? lying / depth : NEW_SNOW
    const melt = Math.min(melting * hours, lying)
    this.#snow = lying - melt
    const most = this.#filmCapacity + this.#puddleCapacity
    const water = Math.min(this.#water + rain * hours + melt, most)
    // Snow keeps what is under it from drying.
    const bare = 1 - this.snowCover
    this.#water = Math.max(
      water - drying * hours * bare * wetFraction(water / this.#filmCapacity),
      0
    )
  }

  #show(): void {
    this.wetnessNode.value = this.wetness
    this.puddlesNode.value = this.puddles
    this.snowCoverNode.value = this.snowCover
  }
}
