import type { Vector4 } from 'three'
import type { Texture } from 'three'
import { If, float, smoothstep, texture } from 'three/tsl'
import type { Renderer, UniformNode } from 'three/webgpu'
import { fail, setOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import { nameTexture } from '../tables/AtlasTexture'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkRange, withDefaults } from '../check'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { groundIrradiance } from '../diffuseLight/tsl/diffuseLight'
import { rayLimits } from '../skyVolume/tsl/rayLimits'
import { sampleVolume } from '../skyVolume/tsl/skyVolume'
import { lightTransmittance } from '../transmittance/tsl/transmittance'
import { meanGroundAlbedo } from './meanGroundAlbedo'
import { groundHit, type GroundHit } from './tsl/groundHit'
import { landRadiance, seaAlbedo, seaRadiance } from './tsl/groundLight'
import { seaSlopeVariance } from './tsl/groundReflection'
import type { GradientSampler } from './tsl/groundTexture'
import { proceduralGround, type GroundSurface } from './tsl/proceduralGround'
import { reflectanceColumns, sunWhite } from './cpu/reflectance'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import { number, vector4 } from '../uniforms'

/** Options of {@link planetGround}. Textures are shared, not owned. */
export interface PlanetGroundOptions {
  /**
   * Colour of the ground, equirectangular: north on top, longitude −180° at the left edge, with
   * `wrapS = RepeatWrapping` and mipmaps. Without one, land, sea and ice are procedural.
   */
  surface?: Texture | null
  /** Open water in its red channel, same projection. Without one, a `surface` has no water. */
  water?: Texture | null
  /** Night lights of towns, same projection; default none. */
  nightLights?: Texture | null
  /** Luminance of white in `nightLights` [cd/m²], default 2. */
  nightLuminance?: number
  /** Roughness of land: standard deviation of its slopes, 0 for Lambertian ground, default 0.35 [rad]. */
  roughness?: number
  /** Wind over the sea, in [0, 40], default 7 [m/s]: calm water glints more sharply. */
  windSpeed?: number
  /** Seed of procedural continents, finite, default 0. */
  seed?: number
}

/** Options that may change later. */
const SETTINGS = ['nightLuminance', 'roughness', 'windSpeed'] as const

const DEFAULTS: Required<PlanetGroundOptions> = {
  surface: null,
  water: null,
  nightLights: null,
  nightLuminance: 2,
  roughness: 0.35,
  windSpeed: 7,
  seed: 0
}

type Columns = [
  UniformNode<'vec4', Vector4>,
  UniformNode<'vec4', Vector4>,
  UniformNode<'vec4', Vector4>
]

const columnUniforms = (): Columns => [0, 1, 2].map(() => vector4()) as Columns

/** Spectrum of a linear-sRGB colour by the columns of a matrix. */
function spectrumOfColor([red, green, blue]: Columns, color: Vec3): Vec4 {
  return red.mul(color.x).add(green.mul(color.y)).add(blue.mul(color.z))
}

/**
 * Ground of the planet where nothing else was drawn, so that a globe never shows a hole: land, sea and ice
 * lit by sun and sky, night lights, the sun's glint on the sea, and the air in front of it.
 *
 * ```ts
 * const ground = planetGround({ surface, water, nightLights })
 * atmosphere.add(ground)
 * ```
 *
 * It replaces the even ground of `skyBackground` and `aerialPerspective`. The shader intersects view rays
 * with the planet's ellipsoid: there are no triangles and no depth that could fight with tiles, and the
 * ground is exact from 1 m to any height. The sea is flat, at height 0; nothing casts shadows.
 *
 * The air still receives the reflected light of `parameters.groundAlbedo`; see {@link meanAlbedo}.
 */
export class PlanetGround implements SkyLayer {
  readonly #options: Required<PlanetGroundOptions>
  /** Columns of the matrix from linear sRGB to reflectance at the four wavelengths. */
  readonly #reflectanceColumns = columnUniforms()
  /** Columns of the matrix from luminance [cd/m²] to radiance over `solarIrradiance` [1/sr]. */
  readonly #radianceColumns = columnUniforms()
  /** Polar over equatorial radius: geodetic latitudes from directions of the mapped sphere. */
  readonly #flattening = number(1)
  readonly #variance = number()
  readonly #roughness = number()
  readonly #nightLuminance = number()

  /** @throws If an option is of the wrong kind or out of its range. */
  constructor(options: PlanetGroundOptions = {}) {
    const { surface, water, nightLights, nightLuminance, roughness, windSpeed, seed } =
      (this.#options = withDefaults('PlanetGround', DEFAULTS, options))
    for (const [name, value] of Object.entries({ surface, water, nightLights })) {
      if (value === null) continue
      if (!value.isTexture) fail('PlanetGround', `${name} must be a Texture or null`, value)
      nameTexture(value, 'PlanetGround')
    }
    if (!Number.isFinite(seed)) fail('PlanetGround', 'seed must be finite', seed)
    this.set({ nightLuminance, roughness, windSpeed })
  }

  /**
   * Changes some settings; textures and seed are fixed.
   *
   * @throws If one is unknown or out of its range; then nothing has changed.
   */
  set(settings: Pick<PlanetGroundOptions, (typeof SETTINGS)[number]>): this {
    return setOptions('PlanetGround', this, settings, ...SETTINGS)
  }

  /** Colour of the ground; shared, not owned. */
  get surface(): Texture | null {
    return this.#options.surface
  }

  /** Mask of open water; shared, not owned. */
  get water(): Texture | null {
    return this.#options.water
  }

  /** Lights of the night; shared, not owned. */
  get nightLights(): Texture | null {
    return this.#options.nightLights
  }

  /** Seed of a procedural planet: another number, other continents. */
  get seed(): number {
    return this.#options.seed
  }

  /** Wind over the sea, in [0, 40] [m/s]. */
  get windSpeed(): number {
    return this.#options.windSpeed
  }

  set windSpeed(value: number) {
    checkRange('PlanetGround', 'windSpeed', value, 0, 40)
    this.#options.windSpeed = value
    this.#variance.value = seaSlopeVariance(value)
  }

  /** Luminance of white in `nightLights`, in [0, 1e6] [cd/m²]. */
  get nightLuminance(): number {
    return this.#nightLuminance.value
  }

  set nightLuminance(value: number) {
    checkRange('PlanetGround', 'nightLuminance', value, 0, 1e6)
    this.#nightLuminance.value = value
  }

  /** Roughness of land: standard deviation of its slopes, in [0, 1.5] [rad]. */
  get roughness(): number {
    return this.#roughness.value
  }

  set roughness(value: number) {
    checkRange('PlanetGround', 'roughness', value, 0, 1.5)
    this.#roughness.value = value
  }

  update({ atmosphere }: AtmosphereView): void {
    this.#setColumns(atmosphere.parameters)
    const { x, z } = atmosphere.ellipsoid.radii
    this.#flattening.value = z / x
  }

  #setColumns(parameters: Parameters<typeof reflectanceColumns>[0]): void {
    const white = sunWhite(parameters)
    reflectanceColumns(parameters).forEach((column, i) => {
      this.#reflectanceColumns[i].value.set(...column)
      this.#radianceColumns[i].value.set(...column).divideScalar(white[i] || 1)
    })
  }

  /** Surface at a geodetic normal; `read` samples a texture there. */
  #surfaceAt(normal: Vec3, footprint: Float, read: (source: Texture) => Vec4): GroundSurface {
    const { surface, water, seed } = this.#options
    if (surface === null) {
      const procedural = proceduralGround(normal, footprint, seed)
      return water === null ? procedural : { ...procedural, water: read(water).x }
    }
    return { color: read(surface).xyz, water: water === null ? float(0) : read(water).x }
  }

  ground(ray: SkyRay, model: Vec4): Vec4 {
    const { view, cosView, cosViewLight, hitsGround } = ray
    const { uniforms } = view.air
    const radiance = model.toVar()
    If(hitsGround, () => {
      const limits = rayLimits(view.viewpoint, cosView, hitsGround)
      const distance = limits.start.add(limits.length).toConst() as Float
      const light = this.#radiance(ray, groundHit(ray, distance, this.#flattening))
      const { volume, viewpoint, source } = view
      const air = sampleVolume(uniforms, volume, viewpoint, cosView, cosViewLight, limits, distance)
      const transmittance = air.depth.negate().exp()
      radiance.assign(air.radiance.mul(source.irradiance).add(light.mul(transmittance)))
    })
    return radiance
  }

  /** Radiance of the ground without the air in front of it [1/sr]. */
  #radiance({ view }: SkyRay, { angles, normal, footprint, ...hit }: GroundHit): Vec4 {
    const { uniforms, transmittance, diffuse } = view.air
    const { cosLight } = angles
    const read = (source: Texture): Vec4 =>
      (texture(source) as unknown as GradientSampler)
        .sample(hit.uv)
        .grad(hit.uvAcross, hit.uvAlong)
        .toConst()
    const { color, water } = this.#surfaceAt(normal, footprint, read)
    const illumination = {
      sun: lightTransmittance(uniforms, transmittance, float(0), cosLight)
        .mul(view.source.irradiance)
        .toConst(),
      sky: groundIrradiance(uniforms, diffuse!, cosLight).mul(view.source.irradiance).toConst()
    }
    const land = landRadiance(illumination, angles, this.#albedoOf(color), this.#roughness)
    const sea = seaRadiance(illumination, angles, this.#variance)
    const radiance = land.mul(water.oneMinus()).add(sea.mul(water)).toVar()
    const { nightLights } = this.#options
    if (nightLights !== null) {
      const isNight = smoothstep(-0.12, 0.02, cosLight).oneMinus()
      const lamps = spectrumOfColor(this.#radianceColumns, read(nightLights).xyz).max(0)
      radiance.addAssign(lamps.mul(this.#nightLuminance).mul(isNight))
    }
    return radiance
  }

  #albedoOf(color: Vec3): Vec4 {
    return spectrumOfColor(this.#reflectanceColumns, color).clamp(0, 1)
  }

  /**
   * Mean albedo of the whole planet, land and sea. Give it to the air with
   * `parameters.set({ groundAlbedo: await ground.meanAlbedo(renderer, parameters) })`.
   */
  async meanAlbedo(
    renderer: Renderer,
    parameters: Parameters<typeof reflectanceColumns>[0]
  ): Promise<Spectrum> {
    this.#setColumns(parameters)
    return meanGroundAlbedo(renderer, (normal, footprint, read) => {
      const { color, water } = this.#surfaceAt(normal, footprint, read)
      return this.#albedoOf(color).mul(water.oneMinus()).add(seaAlbedo().mul(water))
    })
  }
}

/** Ground of the planet where nothing else was drawn: see {@link PlanetGround}. */
export const planetGround = (options: PlanetGroundOptions = {}): PlanetGround =>
  new PlanetGround(options)
