import { DataUtils, Vector4 } from 'three'
import type { Texture } from 'three'
import {
  Fn,
  If,
  atan,
  asin,
  float,
  renderGroup,
  smoothstep,
  texture,
  uniform,
  uv,
  vec2,
  vec3,
  vec4
} from 'three/tsl'
import type { Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { fail, setOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkRange, withDefaults } from '../check'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { reflectanceColumns, sunWhite } from './cpu/reflectance'
import { groundIrradiance } from '../diffuseLight/tsl/diffuseLight'
import { orenNayar, seaSlopeVariance, skyGlint, sunGlint } from './tsl/groundReflection'
import { proceduralGround, type GroundSurface } from './tsl/proceduralGround'
import { rayLimits, sampleVolume } from '../skyVolume/tsl/skyVolume'
import { sunTransmittance } from '../transmittance/tsl/transmittance'
import type { Float, Vec2, Vec3, Vec4 } from '../tsl-types'

/** Options of {@link planetGround}. Textures are shared, not owned. */
export interface PlanetGroundOptions {
  /**
   * Colour of the ground, equirectangular: north on top, longitude −180° at the left edge; wraps
   * around with `wrapS = RepeatWrapping`. Give it mipmaps. Without one, land, sea and ice are made up.
   */
  surface?: Texture | null
  /** Its red says where open water is, same projection. Without one: none with `surface`. */
  water?: Texture | null
  /** Lights of the night, same projection. */
  nightLights?: Texture | null
  /** Luminance of white in `nightLights` [cd/m²], default 2. */
  nightLuminance?: number
  /** Of land: standard deviation of its slopes, 0 for Lambertian ground, default 0.35 [rad]. */
  roughness?: number
  /** Over the sea: calm water glints more sharply; in [0, 40], default 7 [m/s]. */
  windSpeed?: number
  /** Other continents of a made-up planet. */
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

/** Light that comes back out of the sea by absorbing and scattering water, over what fell on it. */
const WATER_BODY = [0.05, 0.03, 0.018, 0.006] as const

/** Part of diffuse light that the sea's surface reflects in all directions. */
const WATER_SURFACE = 0.045

/** Coarsest sight that textures are read for when the size of pixels is not known [rad]. */
const FINEST_PIXEL = 2e-4

type GradientSampler = TextureNode & {
  sample(uv: Vec2): { grad(x: Vec2, y: Vec2): Vec4; level(level: number): Vec4 }
}

/** Equirectangular texture coordinates of a direction from the centre of the mapped sphere. */
function equirectangular(normal: Vec3): Vec2 {
  const longitude = atan(normal.y, normal.x)
  return vec2(longitude.div(2 * Math.PI), asin(normal.z.clamp(-1, 1)).div(Math.PI)).add(0.5)
}

/** How those coordinates change with a small displacement. */
function equirectangularStep(normal: Vec3, step: Vec3): Vec2 {
  const level = normal.x.mul(normal.x).add(normal.y.mul(normal.y)).max(1e-6).toConst()
  const longitude = normal.x.mul(step.y).sub(normal.y.mul(step.x)).div(level)
  const latitude = step.z.div(level.sqrt())
  return vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).clamp(-0.25, 0.25)
}

/**
 * The planet where nothing else was drawn: land, sea and ice lit by sun and sky, with night lights,
 * the sun's glint on the sea, and the air in front of it, so that a globe never shows a hole.
 *
 * ```ts
 * const ground = planetGround({ surface, water, nightLights })
 * atmosphere.add(ground)
 * ```
 *
 * It replaces the even ground of `skyBackground` and `aerialPerspective`. Rays are met with the planet's
 * ellipsoid in the shader: it has no depth and no triangles, never fights with tiles for the same
 * pixels and is exact from 1 m to any height. The sea is at height 0 and flat; nothing casts shadows.
 *
 * The light that the ground throws back at the sky is still that of `parameters.groundAlbedo`; see
 * {@link meanAlbedo}.
 */
export class PlanetGround implements SkyLayer {
  readonly #options: Required<PlanetGroundOptions>
  /** Columns of the matrix from linear sRGB to reflectance at the four wavelengths. */
  readonly #columns = [0, 1, 2].map(() => uniform(new Vector4()).setGroup(renderGroup)) as [
    UniformNode<'vec4', Vector4>,
    UniformNode<'vec4', Vector4>,
    UniformNode<'vec4', Vector4>
  ]
  /** The same, from luminance [cd/m²] to radiance over `solarIrradiance` [1/sr]. */
  readonly #lampColumns = [0, 1, 2].map(() => uniform(new Vector4()).setGroup(renderGroup)) as [
    UniformNode<'vec4', Vector4>,
    UniformNode<'vec4', Vector4>,
    UniformNode<'vec4', Vector4>
  ]
  /** Polar over equatorial radius: geodetic latitudes from directions of the mapped sphere. */
  readonly #flattening = uniform(1).setGroup(renderGroup)
  readonly #variance = uniform(0).setGroup(renderGroup)
  readonly #roughness = uniform(0).setGroup(renderGroup)
  readonly #nightLuminance = uniform(0).setGroup(renderGroup)

  /** @throws If an option is of the wrong kind or out of its range. */
  constructor(options: PlanetGroundOptions = {}) {
    const { surface, water, nightLights, nightLuminance, roughness, windSpeed, seed } =
      (this.#options = withDefaults('PlanetGround', DEFAULTS, options))
    for (const [name, value] of Object.entries({ surface, water, nightLights })) {
      if (value !== null && !value.isTexture) {
        fail('PlanetGround', `${name} must be a Texture or null`, value)
      }
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

  /** Where open water is; shared, not owned. */
  get water(): Texture | null {
    return this.#options.water
  }

  /** Lights of the night; shared, not owned. */
  get nightLights(): Texture | null {
    return this.#options.nightLights
  }

  /** Other continents of a made-up planet. */
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

  /** Of land: standard deviation of its slopes, in [0, 1.5] [rad]. */
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
      this.#columns[i].value.set(...column)
      this.#lampColumns[i].value.set(...column).divideScalar(white[i] || 1)
    })
  }

  /** Four reflectances from linear sRGB. */
  #spectrum(columns: readonly Vec4[], color: Vec3): Vec4 {
    const [red, green, blue] = columns as [Vec4, Vec4, Vec4]
    return red.mul(color.x).add(green.mul(color.y)).add(blue.mul(color.z))
  }

  /** The ground at a geodetic normal, by whichever way a texture is read. */
  #surfaceAt(normal: Vec3, footprint: Float, read: (source: Texture) => Vec4): GroundSurface {
    const { surface, water, seed } = this.#options
    if (surface === null) {
      const made = proceduralGround(normal, footprint, seed)
      return water === null ? made : { ...made, water: read(water).x }
    }
    return { color: read(surface).xyz, water: water === null ? float(0) : read(water).x }
  }

  ground(ray: SkyRay, model: Vec4): Vec4 {
    const { view, cosView, cosViewSun, direction, hitsGround } = ray
    const { air, volume, eye } = view
    const { uniforms } = air
    const radiance = model.toVar()
    If(hitsGround, () => {
      const limits = rayLimits(eye, cosView, hitsGround)
      const distance = limits.start.add(limits.length).toConst() as Float
      const foot = view.up.mul(uniforms.bottomRadius.add(eye.altitude)).add(direction.mul(distance))
      const up = foot.normalize().toConst() as Vec3
      const cosEye = direction.dot(up).negate().clamp(1e-3, 1).toConst() as Float
      const angles = {
        cosSun: up.dot(view.sunDirection).clamp(-1, 1).toConst() as Float,
        cosEye,
        cosSunEye: cosViewSun.negate() as Float
      }
      // A pixel on the ground, in units of the radius: across the line of sight and along it.
      const width = ray.pixel.max(FINEST_PIXEL).mul(distance).div(uniforms.bottomRadius).toConst()
      const side = direction.cross(up).toConst()
      const across = side.div(side.length().max(1e-6)).mul(width).toConst() as Vec3
      const along = up.cross(across).div(cosEye.max(0.02)).toConst() as Vec3
      const normal = up
        .mul(vec3(this.#flattening, this.#flattening, 1))
        .normalize()
        .toConst() as Vec3
      const at = equirectangular(normal).toConst() as Vec2
      const steps = [across, along].map(step => equirectangularStep(normal, step).toConst() as Vec2)
      const read = (source: Texture): Vec4 =>
        (texture(source) as unknown as GradientSampler)
          .sample(at)
          .grad(steps[0], steps[1])
          .toConst()
      const { color, water } = this.#surfaceAt(normal, width.div(cosEye.max(0.1).sqrt()), read)

      const sunlight = sunTransmittance(uniforms, air.transmittance, float(0), angles.cosSun)
        .mul(view.source.irradiance)
        .toConst()
      const skylight = groundIrradiance(uniforms, view.air.diffuse!, angles.cosSun)
        .mul(view.source.irradiance)
        .toConst()
      const level = sunlight.mul(angles.cosSun.max(0)).toConst()
      const rough = orenNayar(angles, this.#roughness)
      const albedo = this.#spectrum(this.#columns, color).clamp(0, 1)
      const land = level.mul(rough).add(skylight).mul(albedo).div(Math.PI)
      const body = level.add(skylight).mul(vec4(...WATER_BODY))
      const mirrored = skylight.mul(skyGlint(cosEye, this.#variance))
      const glint = sunlight.mul(sunGlint(angles, this.#variance))
      const sea = body.add(mirrored).div(Math.PI).add(glint)
      const light = land.mul(water.oneMinus()).add(sea.mul(water)).toVar()
      const { nightLights } = this.#options
      if (nightLights !== null) {
        const isNight = smoothstep(-0.12, 0.02, angles.cosSun).oneMinus()
        const lamps = this.#spectrum(this.#lampColumns, read(nightLights).xyz).max(0)
        light.addAssign(lamps.mul(this.#nightLuminance).mul(isNight))
      }
      const between = sampleVolume(uniforms, volume, eye, cosView, cosViewSun, limits, distance)
      radiance.assign(
        between.radiance.mul(view.source.irradiance).add(light.mul(between.depth.negate().exp()))
      )
    })
    return radiance
  }

  /**
   * Mean reflectance of all the planet, land and sea: give it to the air with
   * `parameters.set({ groundAlbedo: await ground.meanAlbedo(renderer, parameters) })`.
   */
  async meanAlbedo(
    renderer: Renderer,
    parameters: Parameters<typeof reflectanceColumns>[0]
  ): Promise<Spectrum> {
    this.#setColumns(parameters)
    const [width, height] = [128, 64]
    const target = tableTarget('PlanetGround.albedo', width, height)
    const pass = new FragmentPass(
      'Welkin.PlanetGround.albedo',
      Fn(() => {
        // Rows of equal area.
        const z = uv().y.mul(2).sub(1).toConst() as Float
        const longitude = uv()
          .x.sub(0.5)
          .mul(2 * Math.PI)
          .toConst() as Float
        const level = z.mul(z).oneMinus().max(0).sqrt()
        const normal = vec3(longitude.cos().mul(level), longitude.sin().mul(level), z).toConst()
        const at = equirectangular(normal).toConst() as Vec2
        const read = (source: Texture): Vec4 => {
          const across = vec2(1 / width, 0) as unknown as Vec2
          const along = vec2(0, 1 / height) as unknown as Vec2
          return (texture(source) as unknown as GradientSampler).sample(at).grad(across, along)
        }
        const { color, water } = this.#surfaceAt(normal, float(3 / height), read)
        const land = this.#spectrum(this.#columns, color).clamp(0, 1)
        const sea = vec4(...WATER_BODY).add(WATER_SURFACE)
        return land.mul(water.oneMinus()).add(sea.mul(water))
      })()
    )
    pass.render(renderer, target)
    const halves = await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height)
    target.dispose()
    pass.dispose()
    const sum = [0, 0, 0, 0]
    ;(halves as Uint16Array).forEach((half, i) => (sum[i % 4] += DataUtils.fromHalfFloat(half)))
    return sum.map(value => Math.min(value / (width * height), 1)) as unknown as Spectrum
  }
}

/** The planet where nothing else was drawn: see {@link PlanetGround}. */
export const planetGround = (options: PlanetGroundOptions = {}): PlanetGround =>
  new PlanetGround(options)
