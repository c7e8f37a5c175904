import type { Vector4 } from 'three'
import { Vector3 } from 'three'
import { If, exp, vec4 } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { checkOptions, fail } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkFade, checkRange, checkSpectrum, withDefaults } from '../check'
import { checkSources, type LightSource } from '../view/LightSource'
import type { ScatteringPhase } from '../optics/ScatteringPhase'
import { SKY_DISTANCE, type LayerRay, type ShadowedMedium, type SkyLayer } from '../view/SkyLayer'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import { RADIANCE_SCALE } from '../tables/tableSizes'
import { diffuseMoments } from '../diffuseLight/tsl/diffuseLight'
import type { FogOvercast } from './FogOvercast'
import { airMass, fogDepth, henyeyGreenstein, multipleScattering } from './tsl/heightFog'
import { applyMoments, momentBasis } from '../diffuseLight/tsl/moments'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { radianceBetween, volumeSegment } from '../skyVolume/tsl/skyVolume'
import { lightTransmittance } from '../transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../tsl-types'
import { number, vector3, vector4 } from '../uniforms'

/** Options of {@link HeightFog}. */
export interface HeightFogOptions {
  /** Extinction at the base, ≥ 0 [1/m]. Visibility is about 4/density. */
  density?: number
  /** Altitude over which the density falls to 1/e, in [0.1, 1e5] [m]. */
  falloff?: number
  /** Altitude at which the fog has its density: the valley's floor [m]. */
  base?: number
  /** Single-scattering albedo of the droplets at the four wavelengths, in [0, 1]. */
  albedo?: Spectrum
  /** Asymmetry g of the droplets' phase function, in [0, 0.95]; without effect if there are `droplets`. */
  asymmetry?: number
  /**
   * Droplets of a size, `droplets({ radius: 8 })`, with fogbow, glory and corona; shared, not owned. Null,
   * the default, for the smooth phase function of `asymmetry`.
   */
  droplets?: ScatteringPhase | null
  /** Light sources besides the sun, such as the moon's `source`. */
  sources?: readonly LightSource[]
  /** Altitudes of the camera between which the fog fades away, rising [m]. */
  fade?: readonly [number, number]
}

/** Options that may change later. */
const SETTINGS = ['density', 'falloff', 'base', 'albedo', 'asymmetry', 'fade'] as const

/**
 * Height fog: mist with a density that falls off exponentially with altitude, in the haze and in front of
 * the sky too.
 *
 * ```ts
 * atmosphere.add(heightFog({ base: 280, falloff: 40, density: 0.01 }))
 * ```
 *
 * Its optical depth has a closed form on the round planet: nothing is marched, and there are no bands. Sun
 * and sky light it: sunlight dimmed by the air and the fog above, scattered once by the droplets' phase
 * function and more often by Eddington's solution; and the diffuse light of the tables. It does not dim
 * the light on surfaces.
 *
 * The fog covers the whole planet, and fades out as the camera climbs.
 */
export class HeightFog implements SkyLayer {
  declare density: number
  declare falloff: number
  declare base: number
  declare albedo: Spectrum
  declare asymmetry: number
  declare fade: readonly [number, number]
  /** Droplets that it is made of, if given; shared. */
  readonly droplets: ScatteringPhase | null
  /** Clouds' part in its light, by `cloudFogLight` of `@welkin/clouds`; null under a clear sky. Set it before the first render. */
  overcast: FogOvercast | null = null
  readonly #density = number(0)
  readonly #falloff = number(1)
  readonly #height = number(0)
  readonly #asymmetry = number(0)
  readonly #albedo = vector4()
  readonly #lights: readonly FogLight[]
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
    this.droplets = this.#options.droplets
    this.#lights = this.#options.sources.map(source => ({
      source,
      directionMapped: vector3(),
      irradiance: vector4()
    }))
  }

  /** Sources of light besides the sun. */
  get sources(): readonly LightSource[] {
    return this.#options.sources
  }

  /** Extinction at the camera of the last {@link update} [1/m]. */
  get extinction(): number {
    return this.#density.value * Math.exp(Math.min(-this.#height.value / this.#falloff.value, 20))
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version + (this.droplets?.version ?? 0)
  }

  /**
   * Changes settings other than `sources` and `droplets`; no shader is compiled.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: Omit<HeightFogOptions, 'sources' | 'droplets'>): this {
    checkOptions('HeightFog', settings, ...SETTINGS)
    const values = (): string => JSON.stringify({ ...this.#options, sources: [], droplets: null })
    const before = values()
    this.#options = checked(this.#options, settings)
    if (values() !== before) this.#version++
    return this
  }

  prepare(renderer: Renderer, view: AtmosphereView): void {
    if (this.density > 0) this.overcast?.prepare(renderer, view, this.base)
  }

  update(view: AtmosphereView): void {
    this.overcast?.update(view)
    const { density, falloff, base, albedo, asymmetry, fade } = this.#options
    const [low, high] = fade
    const x = Math.min(Math.max((view.height - low) / (high - low), 0), 1)
    this.#density.value = density * (1 - x * x * (3 - 2 * x))
    this.#falloff.value = falloff
    // In float64: float32 of a camera high above sea level has no millimetres.
    this.#height.value = view.height - base
    this.#asymmetry.value = this.droplets?.asymmetry ?? asymmetry
    this.#albedo.value.set(...albedo)
    _position.setFromMatrixPosition(view.camera.matrixWorld)
    for (const { source, directionMapped, irradiance } of this.#lights) {
      source.direction(_direction, _position)
      view.atmosphere.space.direction(_direction, directionMapped.value)
      irradiance.value.set(...source.irradianceAt(_position))
    }
  }

  medium(ray: LayerRay, air: MediumSegment): MediumSegment {
    const depth = vec4(air.depth).toVar()
    const light = vec4(air.radiance).toVar()
    If(this.#density.greaterThan(0), () => {
      const { source, viewpoint } = ray.view
      const { cosViewLight } = ray
      const fog = this.#along(ray)
      // The light of the air in front of that point stays; fog dims the rest.
      const { uniforms } = ray.view.air
      const ahead = radianceBetween(uniforms, ray.view.volume, viewpoint, fog.segment, cosViewLight)
      const front = ahead.mul(source.irradiance).min(air.radiance).toConst()
      const lightOf = (source: LightSource, cosLight: Float, cosViewLight: Float): Vec4 => {
        const { once, often } = this.#light(ray, source, fog.middle, cosLight, cosViewLight)
        return once.add(often)
      }
      let inScatter = lightOf(source, viewpoint.cosLight, cosViewLight).mul(source.irradiance)
      for (const { source: other, directionMapped, irradiance } of this.#lights) {
        const cosLight = ray.view.up.dot(directionMapped).clamp(-1, 1).toConst() as Float
        const cosViewLight = ray.direction.dot(directionMapped).clamp(-1, 1).toConst() as Float
        inScatter = inScatter.add(lightOf(other, cosLight, cosViewLight).mul(irradiance))
      }
      const { through } = fog
      const behind = air.radiance.sub(front).mul(through)
      light.assign(behind.add(front).add(inScatter.mul(fog.seen)))
      depth.addAssign(fog.depth)
    })
    return { depth: depth, radiance: light }
  }

  shadowed(ray: LayerRay & { distance: Float }, isSun: boolean): ShadowedMedium | null {
    if (!isSun && !this.sources.includes(ray.view.source)) return null
    const { source, viewpoint } = ray.view
    const isSky = ray.distance.greaterThanEqual(SKY_DISTANCE)
    const all = rayLimits(viewpoint, ray.cosView).length
    const distance = isSky.select(all, ray.distance).toConst() as Float
    const fog = this.#along({ ...ray, distance })
    const [once, often] = [vec4(0).toVar(), vec4(0).toVar()]
    If(fog.through.lessThan(1), () => {
      const { cosLight } = viewpoint
      const light = this.#light(ray, source, fog.middle, cosLight, ray.cosViewLight)
      once.assign(light.once.mul(fog.seen))
      often.assign(light.often.mul(fog.seen))
    })
    const { through, depthAt } = fog
    return {
      front: fog.middleDistance,
      transmittance: through,
      singleScattered: once,
      multiplyScattered: often,
      distanceAt: part => depthAt(part.mul(through.oneMinus()).oneMinus().log().negate())
    }
  }

  /** Fog along a ray, and the point that stands for all of it. */
  #along(ray: LayerRay) {
    const { air, height, volume, viewpoint } = ray.view
    const limits = rayLimits(viewpoint, ray.cosView, ray.hitsGround)
    const distance = ray.distance ?? limits.length
    const radius = air.uniforms.bottomRadius.add(height).toConst() as Float
    const layer = { density: this.#density as Float, falloff: this.#falloff as Float }
    const { depth, start, fall } = fogDepth(layer, this.#height, radius, ray.cosView, distance)
    const through = exp(depth.negate()).toConst() as Float
    const near = start.min(MAX_ALTITUDE).toConst()
    const here = this.#density.mul(near.negate().exp()).max(1e-30).toConst()
    const above = start.sub(near).div(fall.max(1e-7)).toConst()

    // Distance in the fog to an optical depth, as if altitude changed linearly along the ray.
    const inFogAt = (visible: Float): Float => {
      const growth = visible.mul(fall).div(here).clamp(-0.99, 1e20).toConst()
      const isLevel = growth.abs().lessThan(1e-3)
      const factor = isLevel.select(growth.mul(-0.5).add(1), growth.add(1).log().div(growth))
      return visible.div(here).mul(factor).toConst()
    }
    const distanceTo = (inFog: Float): Float => inFog.add(above).clamp(0, distance).toConst()
    // Point behind half of the fog's visible depth.
    const inFog = inFogAt(depth.min(1).mul(0.5))
    const middleDistance = distanceTo(inFog)
    const middle = near.sub(fall.mul(inFog)).clamp(-20, MAX_ALTITUDE).toConst() as Float
    const segment = volumeSegment(volume, viewpoint, ray.cosView, limits, middleDistance)
    return {
      depth,
      through,
      /** Altitude of the point above the base, in falloff heights. */
      middle,
      middleDistance,
      segment,
      /** Part of the point's light that is seen. */
      seen: this.#albedo.mul(through.oneMinus()).mul(segment.depth.negate().exp()),
      /** Distance to an optical depth of the fog [m]. */
      depthAt: (visible: Float): Float => distanceTo(inFogAt(visible))
    }
  }

  /**
   * Light of a source that fog scatters to the camera, as if all of it were at one point [1/sr]: once, and more often.
   *
   * @param middle - Altitude of the point above the base, in falloff heights.
   */
  #light(
    { view, cosView }: LayerRay,
    source: LightSource,
    middle: Float,
    cosLight: Float,
    cosViewLight: Float
  ): { once: Vec4; often: Vec4 } {
    const { air } = view
    const { uniforms } = air
    const radius = uniforms.bottomRadius.add(view.height)
    const rise = middle.mul(this.#falloff).sub(this.#height)
    const altitude = view.height.add(rise).clamp(0, uniforms.thickness).toConst() as Float
    // Similarity: forward-scattered light counts as not scattered.
    const vertical = this.#density.mul(this.#falloff).mul(this.#asymmetry.oneMinus()).toConst()
    const above = vertical.mul(middle.negate().exp()).toConst() as Float
    const total = above.max(vertical).toConst() as Float
    const slant = airMass(radius.div(this.#falloff), cosLight.max(0))
    const cosSlant = slant.reciprocal().toConst() as Float
    const scaled = above.mul(slant).toConst()
    const smooth = henyeyGreenstein(cosViewLight, this.#asymmetry).toConst()
    let once = vec4(smooth.mul(scaled.negate().exp())) as Vec4
    if (this.droplets !== null) {
      // What light scattered exactly once has of fine structure: depths unscaled.
      const sharp = this.droplets.phase({ cosViewLight, cosView, cosLight }).sub(smooth)
      once = once.add(sharp.mul(scaled.div(this.#asymmetry.oneMinus()).negate().exp()))
    }
    const multiple = multipleScattering(above, total, cosSlant)
    const clouds = this.overcast?.light(source, cosLight)
    const light = lightTransmittance(uniforms, air.transmittance, altitude, cosLight).toConst()
    const moments = diffuseMoments(uniforms, air.diffuse!, altitude, cosLight)
    const basis = momentBasis(cosView, cosLight, cosViewLight)
    const asymmetry = vec4(this.#asymmetry)
    const sky = applyMoments(moments, basis, asymmetry, asymmetry.mul(asymmetry)).max(0)
    const often = light.mul(multiple).add(sky.div(RADIANCE_SCALE))
    const first = light.mul(once)
    return clouds === undefined
      ? { once: first, often }
      : { once: first.mul(clouds.direct), often: often.mul(clouds.diffuse) }
  }
}

/** Light source besides the sun, for the camera that renders. */
interface FogLight {
  source: LightSource
  /** Direction to the source, mapped space, unit length. */
  directionMapped: UniformNode<'vec3', Vector3>
  irradiance: UniformNode<'vec4', Vector4>
}

const DEFAULTS: Required<HeightFogOptions> = {
  density: 0.01,
  falloff: 50,
  base: 0,
  albedo: [1, 1, 1, 1],
  asymmetry: 0.75,
  droplets: null,
  sources: [],
  fade: [5000, 15_000]
}

/** Altitude above which fog is negligible, in falloff heights. */
const MAX_ALTITUDE = 40

const _position = new Vector3()
const _direction = new Vector3()

/** Checked options; undefined ones stay as they were. */
function checked(
  before: Required<HeightFogOptions>,
  given: HeightFogOptions
): Required<HeightFogOptions> {
  const options = withDefaults('HeightFog', before, given)
  const { density, falloff, base, albedo, asymmetry, droplets, sources, fade } = options
  checkRange('HeightFog', 'density', density, 0, 100)
  checkRange('HeightFog', 'falloff', falloff, 0.1, 1e5)
  checkRange('HeightFog', 'base', base, -1e5, 1e6)
  checkRange('HeightFog', 'asymmetry', asymmetry, 0, 0.95)
  checkSpectrum('HeightFog', 'albedo', albedo, 1)
  checkSources('HeightFog', sources)
  checkFade('HeightFog', fade)
  if (droplets !== null && typeof droplets?.phase !== 'function') {
    fail('HeightFog', 'droplets must be droplets() or null', droplets)
  }
  return { ...options, albedo: [...albedo], sources: [...sources], fade: [...fade] }
}

/** Height fog: see {@link HeightFog}. */
export const heightFog = (options?: HeightFogOptions): HeightFog => new HeightFog(options)
