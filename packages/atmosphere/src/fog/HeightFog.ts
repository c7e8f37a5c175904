import type { Vector4 } from 'three'
import { Vector3 } from 'three'
import { If, exp, vec4 } from 'three/tsl'
import type { NodeFrame, Renderer, UniformNode } from 'three/webgpu'
import { checkOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LightSource } from '../view/LightSource'
import type { ScatteringPhase } from '../optics/ScatteringPhase'
import { SKY_DISTANCE, type LayerRay, type ShadowedMedium, type SkyLayer } from '../view/SkyLayer'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import type { Air } from '../scattering/tsl/ray'
import { FogLightTable } from './FogLightTable'
import type { FogOvercast } from './FogOvercast'
import type { ViewUniforms } from '../view/ViewUniforms'
import { checked, DEFAULTS, type HeightFogOptions } from './HeightFogOptions'
import { fogLight, scatteredByFog, type FogLight } from './tsl/fogLight'
import { fogDepth } from './tsl/heightFog'
import { partAhead } from './tsl/partAhead'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { volumeSegment } from '../skyVolume/tsl/skyVolume'
import type { Float, Vec4 } from '../tsl-types'
import { number, vector3, vector4 } from '../uniforms'

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
  readonly #base = number(0)
  readonly #asymmetry = number(0)
  readonly #albedo = vector4()
  readonly #lights: readonly OtherLight[]
  /** Light in the fog, by the sun that lights it. */
  readonly #tables = new Map<LightSource, FogLightTable>()
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

  prepare(renderer: Renderer, view: AtmosphereView, frame?: NodeFrame): void {
    if (view.viewpoint === null) return
    const isNeeded = this.density > 0
    if (isNeeded) this.overcast?.prepare(renderer, view, this.base)
    if (this.droplets !== null) return
    // The table is drawn now, and reads what it depends on.
    this.update(view)
    const others = this.#lights.map(({ directionMapped }) => view.up.dot(directionMapped.value))
    const table = this.#tableOf(view.source, view.atmosphere.tables.air)
    const cosines = [view.viewpoint.cosLight, ...others]
    table.draw(renderer, view.camera, { cosines, isNeeded, renderId: frame?.renderId })
  }

  #tableOf(source: LightSource, air: Air): FogLightTable {
    let table = this.#tables.get(source)
    if (table === undefined) {
      const sources = [source, ...this.sources]
      table = new FogLightTable(sources.length, (index, middle, cosLight) =>
        this.#lightAt(air, sources[index], middle, cosLight)
      )
      this.#tables.set(source, table)
    }
    return table
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
    this.#base.value = base
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
      const { view } = ray
      const { source, viewpoint } = view
      const fog = this.#along(ray)
      // The light of the air in front of that point stays; fog dims the rest.
      const front = air.radiance.mul(partAhead(ray, fog.segment, air.depth)).toConst()
      const lightOf = (index: number, from: LightSource, cosLight: Float, seen: LayerRay): Vec4 => {
        const light = this.#lightIn(view, index, from, fog.middle, cosLight)
        const { once, often } = this.#scattered(light, seen, cosLight)
        return once.add(often)
      }
      let inScatter = lightOf(0, source, viewpoint.cosLight, ray).mul(source.irradiance)
      for (const [i, { source: other, directionMapped, irradiance }] of this.#lights.entries()) {
        const cosLight = view.up.dot(directionMapped).clamp(-1, 1).toConst() as Float
        const cosViewLight = ray.direction.dot(directionMapped).clamp(-1, 1).toConst() as Float
        const light = lightOf(i + 1, other, cosLight, { ...ray, cosViewLight })
        inScatter = inScatter.add(light.mul(irradiance))
      }
      const { through } = fog
      const behind = air.radiance.sub(front).mul(through)
      light.assign(behind.add(front).add(inScatter.mul(fog.seen)))
      depth.addAssign(fog.depth)
    })
    return { depth: depth, radiance: light }
  }

  shadowed(ray: LayerRay & { distance: Float }, isSun: boolean): ShadowedMedium {
    const { source, viewpoint } = ray.view
    const isSky = ray.distance.greaterThanEqual(SKY_DISTANCE)
    const all = rayLimits(viewpoint, ray.cosView).length
    const distance = isSky.select(all, ray.distance).toConst() as Float
    const fog = this.#along({ ...ray, distance })
    const isLit = isSun || this.sources.includes(source)
    const [once, often] = [vec4(0).toVar(), vec4(0).toVar()]
    if (isLit) {
      If(fog.through.lessThan(1), () => {
        const { cosLight } = viewpoint
        // Tables are drawn for the sun's view.
        const light = isSun
          ? this.#lightIn(ray.view, 0, source, fog.middle, cosLight)
          : this.#lightAt(ray.view.air, source, fog.middle, cosLight)
        const scattered = this.#scattered(light, ray, cosLight)
        once.assign(scattered.once.mul(fog.seen))
        often.assign(scattered.often.mul(fog.seen))
      })
    }
    const { through, depthAt } = fog
    return {
      front: fog.middleDistance,
      ahead: depth => partAhead({ ...ray, distance }, fog.segment, depth),
      transmittance: through,
      singleScattered: isLit ? once : null,
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

  /** Light of a source at an altitude: from the table, but that materials have no texture to spare, and droplets take one for themselves. */
  #lightIn(
    { camera, source, air }: ViewUniforms,
    index: number,
    from: LightSource,
    middle: Float,
    cosLight: Float
  ): FogLight {
    return camera === null || this.droplets !== null
      ? this.#lightAt(air, from, middle, cosLight)
      : this.#tableOf(source, air).light(camera, index, middle)
  }

  /**
   * Light of a source at an altitude.
   *
   * @param middle - Altitude above the base, in falloff heights.
   */
  #lightAt(air: Air, source: LightSource, middle: Float, cosLight: Float): FogLight {
    const medium = {
      density: this.#density as Float,
      falloff: this.#falloff as Float,
      base: this.#base as Float,
      asymmetry: this.#asymmetry as Float
    }
    const clouds = this.overcast?.light(source, cosLight)
    return fogLight(air, medium, middle, cosLight, clouds)
  }

  /** Light that fog scatters to the camera, as if all of it were at one point [1/sr]: once, and more often. */
  #scattered(
    light: FogLight,
    { cosView, cosViewLight }: LayerRay,
    cosLight: Float
  ): { once: Vec4; often: Vec4 } {
    const angles = { cosView, cosLight, cosViewLight }
    const phase = this.droplets?.phase(angles)
    return scatteredByFog(light, angles, this.#asymmetry, phase)
  }

  /** Frees the tables of its light, which are drawn again when needed. */
  dispose(): void {
    for (const table of this.#tables.values()) table.dispose()
  }
}

/** Light source besides the sun, for the camera that renders. */
interface OtherLight {
  source: LightSource
  /** Direction to the source, mapped space, unit length. */
  directionMapped: UniformNode<'vec3', Vector3>
  irradiance: UniformNode<'vec4', Vector4>
}

/** Altitude above which fog is negligible, in falloff heights. */
const MAX_ALTITUDE = 40

const _position = new Vector3()
const _direction = new Vector3()

/** Height fog: see {@link HeightFog}. */
export const heightFog = (options?: HeightFogOptions): HeightFog => new HeightFog(options)
