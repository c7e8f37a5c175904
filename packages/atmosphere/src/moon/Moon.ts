import { Matrix3, Matrix4, Vector3, Vector4 } from 'three'
import type { Quaternion } from 'three'
import { If, renderGroup, texture, uniform, mix } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { checkNonNegative, checkPositive, fail } from '@welkin/geo'
import type { Atmosphere } from '../Atmosphere'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkOptions, checkRange } from '../check'
import { CORONA, eclipsedSun } from './cpu/eclipse'
import { earthshine, MOON_RADIUS, moonIrradiance, surfacePhase } from './cpu/moonlight'
import { visibleSun } from '../transmittance/cpu/transmittance'
import { HaloUniforms, type FlareOptions } from '../halo/HaloUniforms'
import { LightSource } from '../view/LightSource'
import { MoonPlace, type MoonGeometry } from './moonGeometry'
import { MoonSurface } from './MoonSurface'
import { MoonlitAir } from './MoonlitAir'
import type { HazeLine, SkyLayer, SkyRay } from '../view/SkyLayer'
import { addHalo } from '../halo/tsl/halo'
import { corona, moonDisc } from './tsl/moonDisc'
import type { Vec4 } from '../tsl-types'
import { checkAtmosphere } from '../view/ViewNodes'

/** Options of {@link Moon}. */
export interface MoonOptions {
  /** To the moon in world space, any length; null follows the date. */
  direction?: Vector3 | null
  /** 0 new, 0.25 first quarter, 0.5 full, 0.75 last quarter, 1 new again; null follows the geometry. */
  phase?: number | null
  /** From the observer [m]; null follows the date, or is the mean distance without one. */
  distance?: number | null
  /** Of the moon [m]. Its light grows with its area. */
  radius?: number
  /** Factor for the light of the disc and by it, ≥ 0. */
  strength?: number
  /** Whether it lights the air: glow of the sky, and haze. */
  lightsAir?: boolean
  /** Its halo; the strengths are of its light, and so wane with it. */
  flare?: FlareOptions
  /** Width of the map of its ground, a power of two [texels]. */
  mapSize?: number
}

/** The moon from somewhere. */
export interface MoonAppearance {
  /** World, unit length. */
  direction: Vector3
  /** From the observer to its centre [m]. */
  distance: number
  /** [rad] */
  angularRadius: number
  /** Between sun and observer, as seen from the moon: 0 full, π new [rad]. */
  phaseAngle: number
  /** Part of the disc that the sun lights, in [0, 1]. */
  litFraction: number
}

/** Angle that a pixel of the coarsest picture covers [rad]. */
const WIDEST_PIXEL = 0.06

/** How far out the corona is drawn, in radii of the sun. */
const CORONA_RADII = 12

const FLARE = { innerPower: 12_000, innerStrength: 0.02, outerPower: 500, outerStrength: 0.006 }

/** How far it must be moved by hand for its light in the air to change: a tenth of a degree [rad]. */
const MOVE = Math.PI / 1800
const NOWHERE = new Vector3()

const _position = new Vector3()
const _matrix = new Matrix4()

const vector = () => uniform(new Vector3()).setGroup(renderGroup)
const spectrum = () => uniform(new Vector4()).setGroup(renderGroup)

/**
 * The moon: its disc, halo and light in the air, and eclipses of the sun by it.
 *
 * ```ts
 * const luna = moon(atmosphere)
 * atmosphere.add(luna)
 * scene.add(new MoonDirectionalLight(atmosphere, luna), new SkyLightProbe(atmosphere, luna.source))
 * ```
 *
 * With `atmosphere.date` set, direction (with the camera's parallax), distance, phase and libration
 * follow the date. Without a date, the moon is as far from the sun as `phase` says, by default opposite
 * it and full. `direction`, `phase` and `distance` can be set by hand at any time; a moon whose direction
 * is set by hand turns its near side to the camera, north up.
 *
 * While added, it eclipses the sun where its disc is before the sun's: light, sky and haze dim as they do
 * at the camera, and the corona shows. Refraction and eclipses of the moon itself are left out.
 */
export class Moon implements SkyLayer {
  /** Shared, not owned. */
  readonly atmosphere: Atmosphere
  /** The moon as a source of light, for lights and probes. */
  readonly source: LightSource
  /** Whether it lights the air: glow of the sky, and haze. Set it before the first render. */
  readonly lightsAir: boolean
  #byHand: Vector3 | null = null
  #phase: number | null = null
  #distance: number | null = null
  #radius = MOON_RADIUS
  #strength = 1
  #version = 0
  /** Where it was when that was last counted up for its direction. */
  readonly #counted = new Vector3()
  readonly #place = new MoonPlace()
  /** Null if it does not light the air. */
  readonly #air: MoonlitAir | null
  readonly #surface: MoonSurface
  readonly #halo = new HaloUniforms('Moon', FLARE)

  readonly #direction = vector()
  readonly #light = vector()
  readonly #toFixed = uniform(new Matrix3()).setGroup(renderGroup)
  readonly #angularRadius = uniform(0).setGroup(renderGroup)
  readonly #sunlit = spectrum()
  readonly #earthlit = spectrum()
  readonly #flare = spectrum()
  /** Cosine of the angle from the sun within which there is something of it. */
  readonly #nearSun = uniform(1).setGroup(renderGroup)
  /** The same of the moon and its halo. */
  readonly #nearMoon = uniform(1).setGroup(renderGroup)
  /** 0 while the sun's disc is all covered, else 1. */
  readonly #sunShows = uniform(1).setGroup(renderGroup)

  /** @throws If an argument is of the wrong kind or out of its range. */
  constructor(atmosphere: Atmosphere, options: MoonOptions = {}) {
    checkAtmosphere('Moon', atmosphere)
    const { lightsAir = true, flare = {}, mapSize = 1024 } = checkOptions('Moon', options)
    if (!(Number.isInteger(Math.log2(mapSize)) && mapSize >= 16 && mapSize <= 8192)) {
      fail('Moon', 'mapSize must be a power of two in [16, 8192]', mapSize)
    }
    this.atmosphere = atmosphere
    this.lightsAir = lightsAir
    this.direction = options.direction ?? null
    this.phase = options.phase ?? null
    this.distance = options.distance ?? null
    this.radius = options.radius ?? MOON_RADIUS
    this.strength = options.strength ?? 1
    this.setFlare(flare)
    this.#surface = new MoonSurface(mapSize)
    this.source = new LightSource(
      (_, target, from = _position.set(0, 0, 0)) => target.copy(this.#worldDirection(from)),
      false
    )
    this.source.irradianceAt = position => this.#irradiance(this.#seenFrom(position))
    this.#air = lightsAir ? new MoonlitAir(atmosphere, this.source) : null
  }

  /** To the moon in world space, unit length, a copy; null while it follows the date. */
  get direction(): Vector3 | null {
    return this.#byHand?.clone() ?? null
  }

  set direction(value: Vector3 | null) {
    const square = value?.isVector3 ? value.lengthSq() : 0
    if (value !== null && !(square > 0 && square < Infinity)) {
      fail('Moon', 'direction must be a Vector3, finite and not zero, or null', value)
    }
    this.#byHand = value?.clone().normalize() ?? null
    const direction = this.#byHand ?? NOWHERE
    if (direction.distanceTo(this.#counted) <= MOVE) return
    this.#counted.copy(direction)
    this.#version++
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  /** 0 new, 0.25 first quarter, 0.5 full, 0.75 last quarter, 1 new again; null follows the geometry. */
  get phase(): number | null {
    return this.#phase
  }

  set phase(value: number | null) {
    if (value !== null) checkRange('Moon', 'phase', value, 0, 1)
    if (value !== this.#phase) this.#version++
    this.#phase = value
  }

  /** From the observer to its centre [m]; null follows the date, or is the mean distance without one. */
  get distance(): number | null {
    return this.#distance
  }

  set distance(value: number | null) {
    if (value !== null) checkPositive('Moon', 'distance', value)
    if (value !== this.#distance) this.#version++
    this.#distance = value
  }

  /** Of the moon [m]. Its light grows with its area. */
  get radius(): number {
    return this.#radius
  }

  set radius(value: number) {
    checkPositive('Moon', 'radius', value)
    if (value !== this.#radius) this.#version++
    this.#radius = value
  }

  /** Factor for the light of the disc and by it, ≥ 0. */
  get strength(): number {
    return this.#strength
  }

  set strength(value: number) {
    checkNonNegative('Moon', 'strength', value)
    if (value !== this.#strength) this.#version++
    this.#strength = value
  }

  /**
   * Changes powers and strengths of the halo.
   *
   * @throws If one is out of its range; then nothing has changed.
   */
  setFlare(options: FlareOptions): this {
    this.#halo.set(options)
    return this
  }

  /**
   * The moon as someone sees it.
   *
   * @param position - World.
   */
  seenFrom(position: Vector3): MoonAppearance {
    const geometry = this.#seenFrom(position)
    const { distance, phaseAngle } = geometry
    return {
      direction: this.#toWorld(geometry.direction),
      distance,
      angularRadius: this.#angularRadiusOf(geometry),
      phaseAngle,
      litFraction: (1 + Math.cos(phaseAngle)) / 2
    }
  }

  #seenFrom(position: Vector3): MoonGeometry {
    return this.#place.seenFrom(this.atmosphere, this, position)
  }

  #toWorld(ecef: Vector3): Vector3 {
    return ecef.clone().transformDirection(_matrix.copy(this.atmosphere.worldToECEF).invert())
  }

  #worldDirection(from: Vector3): Vector3 {
    return this.#byHand ?? this.#toWorld(this.#seenFrom(from).direction)
  }

  #angularRadiusOf({ distance, scale }: MoonGeometry): number {
    return Math.asin(Math.min((scale * this.#radius) / distance, 1))
  }

  #irradiance({ phaseAngle, distance }: MoonGeometry): Spectrum {
    const light = moonIrradiance(phaseAngle, distance, this.#radius)
    return light.map(value => value * this.#strength) as unknown as Spectrum
  }

  /** Part of the sun's light that this moon leaves at a position in world space. */
  eclipse(position: Vector3): Spectrum {
    const { parameters, sunDirection, worldToECEF } = this.atmosphere
    const geometry = this.#seenFrom(position)
    return eclipsedSun(
      geometry.direction.angleTo(sunDirection.transformDirection(worldToECEF)),
      parameters.sunAngularRadius,
      this.#angularRadiusOf(geometry),
      parameters.limbDarkening
    )
  }

  prepare(renderer: Renderer, view: AtmosphereView): void {
    this.#surface.prepare(renderer)
    if (this.#strength > 0) this.#air?.prepare(renderer, view)
  }

  update(view: AtmosphereView): void {
    const { parameters, space } = this.atmosphere
    const geometry = this.#seenFrom(_position.setFromMatrixPosition(view.camera.matrixWorld))
    const { distance, phaseAngle } = geometry
    // ECEF's axes are the mapped space's, but for 0.3 % of squeezing along them.
    space.direction(this.#toWorld(geometry.direction), this.#direction.value)
    this.#light.value.copy(geometry.light)
    setRotation(this.#toFixed.value, geometry.axes.clone().invert())
    const angularRadius = this.#angularRadiusOf(geometry)
    this.#angularRadius.value = angularRadius
    this.#sunShows.value = view.irradiance[1] < 1.001 * CORONA ? 0 : 1
    // A full disc has the Lommel–Seeliger factor ½ all over: twice the mean gives the irradiance.
    const full = moonIrradiance(0, distance, this.#radius).map(
      value => (value * this.#strength) / (Math.PI * angularRadius ** 2)
    )
    const shine = earthshine(phaseAngle, distance, parameters.bottomRadius)
    const bright = surfacePhase(phaseAngle)
    this.#sunlit.value.fromArray(full.map(value => 2 * value * bright))
    this.#earthlit.value.fromArray(full.map((value, i) => value * shine[i]))
    const radius = parameters.bottomRadius + Math.max(view.height, 0)
    const visible = visibleSun(parameters, radius, view.up.dot(this.#direction.value))
    this.#flare.value.set(...this.#irradiance(geometry)).multiplyScalar(visible)
    this.#halo.update(this.#flare.value.y > 0)
    this.#nearSun.value = cosBeyond(CORONA_RADII * parameters.sunAngularRadius)
    this.#nearMoon.value = Math.min(cosBeyond(angularRadius), this.#halo.cosReach.value)
    this.#air?.update(view)
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    const { direction, pixel, view } = ray
    const { uniforms } = view.air
    const light = farther.toVar()
    If(ray.cosViewSun.greaterThan(this.#nearSun), () => {
      const sunDistance = direction.sub(view.sunDirection).length().div(uniforms.sunAngularRadius)
      // In totality smoothed edges would let a thousandth of the disc through, which outshines the corona.
      const nearDisc = pixel.mul(2).div(uniforms.sunAngularRadius).add(1)
      If(sunDistance.lessThan(nearDisc), () => {
        light.mulAssign(this.#sunShows)
      })
      If(sunDistance.lessThan(CORONA_RADII), () => {
        light.addAssign(corona(uniforms, sunDistance))
      })
    })
    const cosMoon = direction.dot(this.#direction).toConst()
    If(cosMoon.greaterThan(this.#nearMoon), () => {
      If(direction.sub(this.#direction).length().lessThan(this.#angularRadius.add(pixel)), () => {
        const disc = moonDisc(
          {
            direction: this.#direction,
            light: this.#light,
            toFixed: this.#toFixed,
            angularRadius: this.#angularRadius,
            sunlit: this.#sunlit,
            earthlit: this.#earthlit,
            map: texture(this.#surface.target.texture)
          },
          direction,
          pixel
        )
        light.assign(mix(light, disc.radiance, disc.coverage))
      })
      addHalo(light, this.#halo, this.#flare, direction, this.#direction, cosMoon)
    })
    return light
  }

  glow(ray: SkyRay, without: Vec4): Vec4 {
    return this.#air?.glow(ray, without) ?? without
  }

  haze(line: HazeLine, without: Vec4): Vec4 {
    return this.#air?.haze(line, without) ?? without
  }

  /** Frees GPU memory and leaves the atmosphere. The moon can be added again. */
  dispose(): void {
    this.atmosphere.remove(this)
    this.#surface.dispose()
    this.#air?.dispose()
  }
}

/** Cosine of an angle and the widest pixels' more [rad]. */
const cosBeyond = (angle: number): number => Math.cos(Math.min(angle + WIDEST_PIXEL, Math.PI))

function setRotation(target: Matrix3, rotation: Quaternion): void {
  target.setFromMatrix4(_matrix.makeRotationFromQuaternion(rotation))
}

/** The moon: see {@link Moon}. */
export const moon = (atmosphere: Atmosphere, options: MoonOptions = {}): Moon =>
  new Moon(atmosphere, options)
