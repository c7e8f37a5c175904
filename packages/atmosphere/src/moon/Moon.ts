import { Matrix4, Vector3 } from 'three'
import { texture } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import {
  checkBoolean,
  checkDirection,
  checkNonNegative,
  checkOptions,
  checkPositive,
  checkVector,
  fail,
  setOptions
} from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkRange } from '../check'
import { eclipsedSunlight } from './cpu/eclipse'
import { MOON_RADIUS, moonIrradiance } from './cpu/moonIrradiance'
import { Flare } from '../halo/Flare'
import { LightSource } from '../view/LightSource'
import type { MoonAppearance, MoonOptions } from './MoonOptions'
import { moonGeometryFrom, type MoonGeometry } from './moonGeometry'
import { MoonSurfaceMap } from './MoonSurfaceMap'
import { MoonlitAir } from './MoonlitAir'
import { MoonUniforms } from './MoonUniforms'
import { SunMoonEphemeris } from './sunMoonEphemeris'
import type { PointRay, SkyLayer, SkyRay } from '../view/SkyLayer'
import { moonSky } from './tsl/moonSky'
import type { Vec4 } from '../tsl-types'
import { checkAtmosphere } from '../view/ViewNodes'

/** Atmosphere that a moon is in, and what the moon made for it. */
interface Home {
  readonly atmosphere: Atmosphere
  readonly source: LightSource
  readonly air: MoonlitAir | null
}

/** Options that may change later. */
const SETTINGS = ['direction', 'phase', 'distance', 'radius', 'strength', 'earthshine'] as const

/**
 * Default halo, found by looking: lobes with standard deviations of 0.5° and 2.6° (1/√power). Larger
 * strengths wash out the disc's dark seas and the stars beside it. Story: Moon, Full.
 */
const FLARE = { innerPower: 12_000, innerStrength: 0.02, outerPower: 500, outerStrength: 0.006 }

/** Smallest move of `direction` that counts as a change of the light in the air: 0.1° [rad]. */
const DIRECTION_TOLERANCE = Math.PI / 1800
const NO_DIRECTION = new Vector3()

const _position = new Vector3()
const _matrix = new Matrix4()

/**
 * The moon: its disc, halo and light in the air, and eclipses of the sun by it.
 *
 * ```ts
 * const luna = moon()
 * atmosphere.add(luna)
 * scene.add(new MoonDirectionalLight(atmosphere, luna), new SkyLightProbe(atmosphere, luna.source))
 * ```
 *
 * With `atmosphere.date` set, direction (with the camera's parallax), distance, phase and libration
 * follow the date. Without a date, `phase` sets the moon's elongation from the sun; by default it is
 * opposite the sun and full. `direction`, `phase` and `distance` can be set at any time; a moon whose
 * direction is set turns its near side to the camera, north up.
 *
 * While added, the moon eclipses the sun where its disc is in front of the sun's: light, sky and haze dim
 * by the obscuration at the camera, and the corona shows. Refraction and eclipses of the moon itself are
 * left out.
 */
export class Moon implements SkyLayer {
  /** The moon lights the air: glow of the sky, and haze. */
  readonly lightsAir: boolean
  #directionWorld: Vector3 | null = null
  #phase: number | null = null
  #distance: number | null = null
  #radius = MOON_RADIUS
  #strength = 1
  #earthshine = 1
  #version = 0
  /** Direction at the last change of `version`. */
  readonly #versionDirection = new Vector3()
  readonly #ephemeris = new SunMoonEphemeris()
  readonly #surface: MoonSurfaceMap
  /** Its halo; the strengths are of its light. Change it by its properties or with `flare.set(…)`. */
  readonly flare = new Flare('Moon', FLARE)
  /** Width of the map of its ground [texels]. */
  readonly mapSize: number
  /** Null before it is added. */
  #home: Home | null = null
  readonly #uniforms = new MoonUniforms()

  /** @throws If an argument is of the wrong kind or out of its range. */
  constructor(options: MoonOptions = {}) {
    checkOptions('Moon', options, ...SETTINGS, 'lightsAir', 'flare', 'mapSize')
    const { lightsAir = true, flare = {}, mapSize = 1024, ...settings } = options
    checkBoolean('Moon', 'lightsAir', lightsAir)
    if (!(Number.isInteger(Math.log2(mapSize)) && mapSize >= 16 && mapSize <= 8192)) {
      fail('Moon', 'mapSize must be a power of two in [16, 8192]', mapSize)
    }
    this.lightsAir = lightsAir
    this.mapSize = mapSize
    this.flare.set(flare)
    this.set(settings)
    this.#surface = new MoonSurfaceMap(mapSize)
  }

  /**
   * Makes it the moon of an atmosphere, for good. `atmosphere.add` and `MoonDirectionalLight` do this.
   *
   * @throws If it is another atmosphere's.
   */
  attach(atmosphere: Atmosphere): this {
    checkAtmosphere('Moon.attach', atmosphere)
    if (this.#home !== null) {
      if (this.#home.atmosphere === atmosphere) return this
      fail('Moon.attach', 'atmosphere must be the one that it was added to before')
    }
    const source = new LightSource(
      (target, from = _position.set(0, 0, 0)) => target.copy(this.#directionFrom(from)),
      false
    )
    source.irradianceAt = position => this.#irradiance(this.#geometryFrom(position))
    const air = this.lightsAir ? new MoonlitAir(atmosphere, source) : null
    this.#home = { atmosphere, source, air }
    return this
  }

  #inHome(): Home {
    return this.#home ?? fail('Moon', 'is in no atmosphere yet: call atmosphere.add(moon) first')
  }

  /** Atmosphere that it is in, once it was added. Shared, not owned. */
  get atmosphere(): Atmosphere {
    return this.#inHome().atmosphere
  }

  /** The moon as a source of light, for lights and probes, once it was added. */
  get source(): LightSource {
    return this.#inHome().source
  }

  /** Direction to the moon in world space, unit length, a copy; null while it follows the date. */
  get direction(): Vector3 | null {
    return this.#directionWorld?.clone() ?? null
  }

  set direction(value: Vector3 | null) {
    if (value !== null) {
      if (!value?.isVector3) fail('Moon', 'direction must be a Vector3 or null', value)
      checkDirection('Moon', 'direction', value)
    }
    this.#directionWorld = value?.clone().normalize() ?? null
    const direction = this.#directionWorld ?? NO_DIRECTION
    if (direction.distanceTo(this.#versionDirection) <= DIRECTION_TOLERANCE) return
    this.#versionDirection.copy(direction)
    this.#version++
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  /** Phase: 0 new, 0.25 first quarter, 0.5 full, 0.75 last quarter, 1 new; null follows the geometry. */
  get phase(): number | null {
    return this.#phase
  }

  set phase(value: number | null) {
    if (value !== null) checkRange('Moon', 'phase', value, 0, 1)
    if (value !== this.#phase) this.#version++
    this.#phase = value
  }

  /** Observer to the moon's centre [m]; null follows the date, or is the mean distance without one. */
  get distance(): number | null {
    return this.#distance
  }

  set distance(value: number | null) {
    if (value !== null) checkPositive('Moon', 'distance', value)
    if (value !== this.#distance) this.#version++
    this.#distance = value
  }

  /** Radius of the moon [m]. Its light grows with its area. */
  get radius(): number {
    return this.#radius
  }

  set radius(value: number) {
    checkPositive('Moon', 'radius', value)
    if (value !== this.#radius) this.#version++
    this.#radius = value
  }

  /** Factor on the brightness of the disc and on moonlight, ≥ 0. */
  get strength(): number {
    return this.#strength
  }

  set strength(value: number) {
    checkNonNegative('Moon', 'strength', value)
    if (value !== this.#strength) this.#version++
    this.#strength = value
  }

  /** Artistic factor on earthshine, the glow of the moon's dark side, ≥ 0; at 1 it is physical. */
  get earthshine(): number {
    return this.#earthshine
  }

  set earthshine(value: number) {
    checkNonNegative('Moon', 'earthshine', value)
    if (value !== this.#earthshine) this.#version++
    this.#earthshine = value
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: Pick<MoonOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('Moon', this, settings, ...SETTINGS)
  }

  /**
   * Appearance of the moon for an observer.
   *
   * @param position - Position of the observer, world.
   */
  seenFrom(position: Vector3): MoonAppearance {
    checkVector('Moon.seenFrom', 'position', position)
    const geometry = this.#geometryFrom(position)
    const { distance, phaseAngle } = geometry
    return {
      direction: this.#toWorld(geometry.directionECEF),
      distance,
      angularRadius: this.#angularRadiusOf(geometry),
      phaseAngle,
      litFraction: (1 + Math.cos(phaseAngle)) / 2
    }
  }

  #geometryFrom(positionWorld: Vector3): MoonGeometry {
    return moonGeometryFrom(this.#ephemeris, this.atmosphere, this, positionWorld)
  }

  #toWorld(directionECEF: Vector3): Vector3 {
    return directionECEF
      .clone()
      .transformDirection(_matrix.copy(this.atmosphere.worldToECEF).invert())
  }

  #directionFrom(positionWorld: Vector3): Vector3 {
    return this.#directionWorld ?? this.#toWorld(this.#geometryFrom(positionWorld).directionECEF)
  }

  #angularRadiusOf({ distance, scale }: MoonGeometry): number {
    return Math.asin(Math.min((scale * this.#radius) / distance, 1))
  }

  #irradiance({ phaseAngle, distance }: MoonGeometry): Spectrum {
    const light = moonIrradiance(phaseAngle, distance, this.#radius)
    return light.map(value => value * this.#strength) as unknown as Spectrum
  }

  /** Fraction of the sun's light left by this moon at a position in world space. */
  eclipse(position: Vector3): Spectrum {
    const { parameters, sunDirection, worldToECEF } = this.atmosphere
    const geometry = this.#geometryFrom(position)
    return eclipsedSunlight(
      geometry.directionECEF.angleTo(sunDirection.transformDirection(worldToECEF)),
      parameters.sunAngularRadius,
      this.#angularRadiusOf(geometry),
      parameters.limbDarkening
    )
  }

  prepare(renderer: Renderer, view: AtmosphereView): void {
    this.#surface.prepare(renderer)
    this.#home?.air?.prepare(renderer, view, this.#strength > 0)
  }

  update(view: AtmosphereView): void {
    const geometry = this.#geometryFrom(_position.setFromMatrixPosition(view.camera.matrixWorld))
    const state = {
      geometry,
      directionWorld: this.#toWorld(geometry.directionECEF),
      angularRadius: this.#angularRadiusOf(geometry),
      radius: this.#radius,
      strength: this.#strength,
      earthshine: this.#earthshine,
      irradiance: this.#irradiance(geometry)
    }
    this.#uniforms.update(view, state, this.flare)
    this.#home?.air?.update(view)
  }

  background(ray: SkyRay, background: Vec4): Vec4 {
    const map = texture(this.#surface.target.texture)
    return moonSky(this.#uniforms, map, this.flare.uniforms, ray, background)
  }

  glow(ray: SkyRay, without: Vec4): Vec4 {
    return this.#inHome().air?.glow(ray, without) ?? without
  }

  inScatter(ray: PointRay, without: Vec4): Vec4 {
    return this.#inHome().air?.inScatter(ray, without) ?? without
  }

  /** Frees GPU memory and leaves the atmosphere. The moon can be added again. */
  dispose(): void {
    this.#home?.atmosphere.remove(this)
    this.#home?.air?.dispose()
    this.#surface.dispose()
  }
}

/** The moon: see {@link Moon}. */
export const moon = (options?: MoonOptions): Moon => new Moon(options)
