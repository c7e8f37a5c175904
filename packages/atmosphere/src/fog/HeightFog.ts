import { Vector3, Vector4 } from 'three'
import { If, exp, renderGroup, uniform, vec4 } from 'three/tsl'
import type { UniformNode } from 'three/webgpu'
import { checkOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkFade, checkRange, checkSpectrum, withDefaults } from '../check'
import { checkSources, type LightSource } from '../view/LightSource'
import type { Sightline, SkyLayer, Veil } from '../view/SkyLayer'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { diffuseMoments } from '../diffuseLight/tsl/diffuseLight'
import { airMass, fogDepth, henyeyGreenstein, multipleScattering } from './tsl/heightFog'
import { applyMoments, momentBasis } from '../diffuseLight/tsl/moments'
import { rayLimits, sampleVolume } from '../skyVolume/tsl/skyVolume'
import { sunTransmittance } from '../transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../tsl-types'

/** Options of {@link HeightFog}. */
export interface HeightFogOptions {
  /** Extinction at the base, ≥ 0 [1/m]. 4 over it is about how far one sees. */
  density?: number
  /** Altitude over which the density falls to 1/e, in [0.1, 1e5] [m]. */
  falloff?: number
  /** Altitude at which the fog has its density: the valley's floor [m]. */
  base?: number
  /** Part of the light that droplets scatter rather than absorb, at the four wavelengths, in [0, 1]. */
  albedo?: Spectrum
  /** g of the droplets' phase function, in [0, 0.95]. */
  asymmetry?: number
  /** What lights it besides the sun: the moon's `source`. */
  sources?: readonly LightSource[]
  /** Altitudes of the camera between which the fog fades away, rising [m]. */
  fade?: readonly [number, number]
}

/** Options that may change later. */
const SETTINGS = ['density', 'falloff', 'base', 'albedo', 'asymmetry', 'fade'] as const

/**
 * Ground fog: mist whose density falls off exponentially with altitude, over and in the haze, in front of
 * the sky too.
 *
 * ```ts
 * atmosphere.add(heightFog({ base: 280, falloff: 40, density: 0.01 }))
 * ```
 *
 * Its optical depth has a closed form on the round planet, so nothing is marched and there are no bands.
 * The same sun and sky light it: the sun dimmed by the air and by the fog above, once by the droplets' phase
 * function and again by Eddington's solution for what is scattered more often; and the diffuse light of
 * the tables. It casts no shadow on what is in it: light on surfaces stays as it was.
 *
 * The fog is everywhere on the planet, so that it fades out as the camera climbs.
 */
export class HeightFog implements SkyLayer {
  declare density: number
  declare falloff: number
  declare base: number
  declare albedo: Spectrum
  declare asymmetry: number
  declare fade: readonly [number, number]
  readonly #density = number(0)
  readonly #falloff = number(1)
  readonly #height = number(0)
  readonly #asymmetry = number(0)
  readonly #albedo = uniform(new Vector4()).setGroup(renderGroup)
  readonly #lamps: readonly Lamp[]
  #options: Required<HeightFogOptions>
  #version = 0

  static {
    for (const name of SETTINGS) {
      Object.defineProperty(HeightFog.prototype, name, {
        get(this: HeightFog) {
          return this.#options[name]
        },
        set(this: HeightFog, value: unknown) {
          this.set({ [name]: value })
        }
      })
    }
  }

  /** @throws If an option is out of range. */
  constructor(options: HeightFogOptions = {}) {
    this.#options = checked(DEFAULTS, options)
    this.#lamps = this.#options.sources.map(source => ({
      source,
      direction: uniform(new Vector3()).setGroup(renderGroup),
      irradiance: uniform(new Vector4()).setGroup(renderGroup)
    }))
  }

  /** What lights it besides the sun. */
  get sources(): readonly LightSource[] {
    return this.#options.sources
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  /**
   * Changes some settings, of which `sources` are fixed; nothing is compiled.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Omit<HeightFogOptions, 'sources'>): this {
    checkOptions('HeightFog', settings, ...SETTINGS)
    const values = (): string => JSON.stringify({ ...this.#options, sources: [] })
    const before = values()
    this.#options = checked(this.#options, settings)
    if (values() !== before) this.#version++
    return this
  }

  update(view: AtmosphereView): void {
    const { density, falloff, base, albedo, asymmetry, fade } = this.#options
    const [low, high] = fade
    const x = Math.min(Math.max((view.height - low) / (high - low), 0), 1)
    this.#density.value = density * (1 - x * x * (3 - 2 * x))
    this.#falloff.value = falloff
    // In float64: in a shader a camera high above sea level has no millimetres.
    this.#height.value = view.height - base
    this.#asymmetry.value = asymmetry
    this.#albedo.value.set(...albedo)
    _position.setFromMatrixPosition(view.camera.matrixWorld)
    for (const { source, direction, irradiance } of this.#lamps) {
      source.direction(_direction, _position)
      view.atmosphere.space.direction(_direction, direction.value)
      irradiance.value.set(...source.irradianceAt(_position))
    }
  }

  veil(line: Sightline, air: Veil): Veil {
    const depth = vec4(air.depth).toVar()
    const light = vec4(air.light).toVar()
    If(this.#density.greaterThan(0), () => {
      const { uniforms } = line.view.air
      const { eye, source } = line.view
      const limits = rayLimits(eye, line.cosView, line.hitsGround)
      const distance = line.distance ?? limits.length
      const radius = uniforms.bottomRadius.add(line.view.height).toConst() as Float
      const layer = { density: this.#density as Float, falloff: this.#falloff as Float }
      const fog = fogDepth(layer, this.#height, radius, line.cosView, distance)
      const through = exp(fog.depth.negate()).toConst()

      // Where half of what shows of the fog is passed, for an altitude that changes evenly.
      const shown = fog.depth.min(1).mul(0.5)
      const near = fog.start.min(HIGH).toConst()
      const here = this.#density.mul(near.negate().exp()).max(1e-30).toConst()
      const growth = shown.mul(fog.fall).div(here).clamp(-0.99, 1e20).toConst()
      const isEven = growth.abs().lessThan(1e-3)
      const factor = isEven.select(growth.mul(-0.5).add(1), growth.add(1).log().div(growth))
      const inFog = shown.div(here).mul(factor).toConst()
      const above = fog.start.sub(near).div(fog.fall.max(1e-7))
      const reach = inFog.add(above).clamp(0, distance).toConst() as Float
      const middle = near.sub(fog.fall.mul(inFog)).clamp(-20, HIGH).toConst() as Float

      // The air in front of that and its light; fog dims the rest.
      const { volume } = line.view
      const { cosView, cosViewSun } = line
      const ahead = sampleVolume(uniforms, volume, eye, cosView, cosViewSun, limits, reach)
      const front = ahead.radiance.mul(source.irradiance).min(air.light).toConst()
      const place = { line, radius, middle }
      let own = this.#light(place, eye.cosSun, cosViewSun).mul(source.irradiance)
      for (const { direction, irradiance } of this.#lamps) {
        const cosLamp = line.view.up.dot(direction).clamp(-1, 1).toConst() as Float
        const cosViewLamp = line.direction.dot(direction).clamp(-1, 1).toConst() as Float
        own = own.add(this.#light(place, cosLamp, cosViewLamp).mul(irradiance))
      }
      own = own.mul(this.#albedo).mul(through.oneMinus()).mul(ahead.depth.negate().exp())
      light.assign(air.light.sub(front).mul(through).add(front).add(own))
      depth.addAssign(fog.depth)
    })
    return { depth: depth, light: light }
  }

  /** Sunlight that fog scatters towards the eye, for all of it at one altitude [1/sr]. */
  #light({ line, radius, middle }: FogPlace, cosSun: Float, cosViewSun: Float): Vec4 {
    const { view, cosView } = line
    const { air } = view
    const { uniforms } = air
    const rise = middle.mul(this.#falloff).sub(this.#height)
    const altitude = view.height.add(rise).clamp(0, uniforms.thickness).toConst() as Float
    // Depths by similarity: light that droplets deflect a little counts as not scattered.
    const vertical = this.#density.mul(this.#falloff).mul(this.#asymmetry.oneMinus()).toConst()
    const above = vertical.mul(middle.negate().exp()).toConst() as Float
    const whole = above.max(vertical).toConst() as Float
    const slant = airMass(radius.div(this.#falloff), cosSun.max(0))
    const cosSlant = slant.reciprocal().toConst() as Float
    const once = henyeyGreenstein(cosViewSun, this.#asymmetry).mul(above.mul(slant).negate().exp())
    const often = multipleScattering(above, whole, cosSlant)
    const sun = sunTransmittance(uniforms, air.transmittance, altitude, cosSun).mul(once.add(often))
    const moments = diffuseMoments(uniforms, air.diffuse!, altitude, cosSun)
    const basis = momentBasis(cosView, cosSun, cosViewSun)
    const asymmetry = vec4(this.#asymmetry)
    const sky = applyMoments(moments, basis, asymmetry, asymmetry.mul(asymmetry))
    return sun.add(sky.max(0).div(RADIANCE_SCALE))
  }
}

/** A source besides the sun, as seen from the camera. */
interface Lamp {
  source: LightSource
  /** In the mapped space. */
  direction: UniformNode<'vec3', Vector3>
  irradiance: UniformNode<'vec4', Vector4>
}

/** Where on a line fog is lit. */
interface FogPlace {
  line: Sightline
  /** Planet's centre to the eye [m]. */
  radius: Float
  /** Altitude above the base, in falloff heights. */
  middle: Float
}

const DEFAULTS: Required<HeightFogOptions> = {
  density: 0.01,
  falloff: 50,
  base: 0,
  albedo: [1, 1, 1, 1],
  asymmetry: 0.75,
  sources: [],
  fade: [5000, 15_000]
}

/** Altitude in falloff heights above which there is as good as no fog. */
const HIGH = 40

const _position = new Vector3()
const _direction = new Vector3()

const number = (value: number) => uniform(value).setGroup(renderGroup)

/** Options with defaults; those that are undefined stay as they are. */
function checked(
  before: Required<HeightFogOptions>,
  given: HeightFogOptions
): Required<HeightFogOptions> {
  const options = withDefaults('HeightFog', before, given)
  const { density, falloff, base, albedo, asymmetry, sources, fade } = options
  checkRange('HeightFog', 'density', density, 0, 100)
  checkRange('HeightFog', 'falloff', falloff, 0.1, 1e5)
  checkRange('HeightFog', 'base', base, -1e5, 1e6)
  checkRange('HeightFog', 'asymmetry', asymmetry, 0, 0.95)
  checkSpectrum('HeightFog', 'albedo', albedo, 1)
  checkSources('HeightFog', sources)
  checkFade('HeightFog', fade)
  return { ...options, albedo: [...albedo], sources: [...sources], fade: [...fade] }
}

/** Ground fog: see {@link HeightFog}. */
export const heightFog = (options?: HeightFogOptions): HeightFog => new HeightFog(options)
