import { If, float, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import { setOptions } from '@welkin/geo'
import type { AtmosphereView, ViewedAtmosphere } from '../view/AtmosphereView'
import { checkFade, checkRange } from '../check'
import { SKY_DISTANCE, type LayerRay, type ShadowedMedium, type SkyLayer } from '../view/SkyLayer'
import { densities } from '../air/tsl/medium'
import { scatteredRadiance } from '../scattering/tsl/scattering'
import { sourceFunction } from '../scattering/tsl/segment'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import { sampleSky } from '../skyVolume/tsl/skyVolume'
import { viewRay } from '../skyVolume/tsl/viewRay'
import type { Bool, Float, Vec4 } from '../tsl-types'
import { number } from '../uniforms'
import type { FogOvercast } from './FogOvercast'

/** Options of {@link DistanceFog}. */
export interface DistanceFogOptions {
  /** Density as in three's `FogExp2`: at distance 1/density e⁻¹ of the light is left; in [0, 100], default 1e-4 [1/m]. */
  density?: number
  /** Altitudes of the camera between which the fog fades away, rising; default [5000, 15,000] [m]. */
  fade?: readonly [number, number]
}

/**
 * Fog by distance alone, exp(−(density × distance)²) as three's `FogExp2`, in the colour of the sky: far
 * objects take the colour of the horizon behind them and vanish into it at any time of day. It hides the
 * end of a scene. The sky itself stays clear.
 *
 * ```ts
 * atmosphere.add(distanceFog({ density: 1 / 4000 }))
 * ```
 */
export class DistanceFog implements SkyLayer {
  readonly leavesSky = true
  /** Clouds' part in its light, by `cloudFogLight` of `@welkin/clouds`; null under a clear sky. Set it before the first render. */
  overcast: FogOvercast | null = null
  #value = 1e-4
  #fade: readonly [number, number] = [5000, 15_000]
  #version = 0
  readonly #density = number()
  #atmosphere: ViewedAtmosphere | null = null

  /** @throws If an option is out of range. */
  constructor(options: DistanceFogOptions = {}) {
    this.set(options)
    this.#version = 0
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: DistanceFogOptions): this {
    return setOptions('DistanceFog', this, settings, 'density', 'fade')
  }

  /** See {@link DistanceFogOptions}, rising [m]. */
  get fade(): readonly [number, number] {
    return this.#fade
  }

  set fade(value: readonly [number, number]) {
    checkFade('DistanceFog', value)
    this.#fade = [...value]
    this.#version++
  }

  /** See {@link DistanceFogOptions}, in [0, 100] [1/m]. */
  get density(): number {
    return this.#value
  }

  set density(value: number) {
    checkRange('DistanceFog', 'density', value, 0, 100)
    if (value !== this.#value) this.#version++
    this.#value = value
  }

  /** Reciprocal of the distance at which e⁻¹ of the light is left, for the camera of the last {@link update} [1/m]. */
  get extinction(): number {
    return this.#density.value
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  attach(atmosphere: ViewedAtmosphere): void {
    this.#atmosphere = atmosphere
  }

  prepare(renderer: Renderer, view: AtmosphereView): void {
    this.overcast?.prepare(renderer, view, Math.max(view.height, 0))
  }

  update(view: AtmosphereView): void {
    this.overcast?.update(view)
    const [low, high] = this.fade
    const x = Math.min(Math.max((view.height - low) / (high - low), 0), 1)
    this.#density.value = this.density * (1 - x * x * (3 - 2 * x))
  }

  medium(ray: LayerRay, air: MediumSegment): MediumSegment {
    const { distance } = ray
    if (distance === undefined) return air
    const depth = vec4(air.depth).toVar()
    const light = vec4(air.radiance).toVar()
    If(this.#density.greaterThan(0), () => {
      const color = this.#color(ray, raisedSky(ray).light.mul(ray.view.source.irradiance))
      const fog = this.#depth(distance)
      const through = fog.negate().exp().toConst()
      light.assign(air.radiance.mul(through).add(color.mul(through.oneMinus())))
      depth.addAssign(fog)
    })
    return { depth: depth, radiance: light }
  }

  shadowed(ray: LayerRay & { distance: Float }, isSun: boolean): ShadowedMedium {
    // The sky has no such fog.
    const isSky = ray.distance.greaterThanEqual(SKY_DISTANCE)
    const through = isSky.select(1, this.#depth(ray.distance).negate().exp()).toConst() as Float
    const dimmed = {
      front: float(0),
      transmittance: through,
      singleScattered: null,
      multiplyScattered: vec4(0),
      distanceAt: () => ray.distance
    }
    // It shows the sun's sky alone.
    if (!isSun) return dimmed
    const { light: sky, cosView, cosViewLight } = raisedSky(ray)
    const light = this.#color(ray, sky)
    // The sky's light is scattered once in about the part that it is at the camera.
    const { air, height, viewpoint } = ray.view
    const altitude = height.clamp(0, air.uniforms.thickness) as Float
    const here = { altitude, cosView, cosLight: viewpoint.cosLight, cosViewLight }
    const density = densities(air.uniforms, altitude)
    const [direct, diffuse] = [true, false].map(direct => {
      const parts = sourceFunction(air, here, float(0), density, { direct, diffuse: !direct })
      return scatteredRadiance(air.uniforms, parts, cosViewLight).toConst()
    })
    const part = direct.div(direct.add(diffuse).max(1e-30)).toConst()
    const added = light.mul(through.oneMinus()).toConst()
    const inverse = this.#density.max(1e-12).reciprocal().toConst()
    return {
      ...dimmed,
      singleScattered: added.mul(part).toConst(),
      multiplyScattered: added.mul(part.oneMinus()).toConst(),
      distanceAt(share) {
        const depth = share.mul(through.oneMinus()).oneMinus().log().negate()
        return depth.max(0).sqrt().mul(inverse).min(ray.distance).toConst()
      }
    }
  }

  /** Its colour, for unit irradiance of the sun [1/sr]: that of the sky, under clouds as much darker as the ground. */
  #color({ view: { source, viewpoint } }: LayerRay, sky: Vec4): Vec4 {
    const shown = this.#shown(sky)
    const clouds = this.overcast?.light(source, viewpoint.cosLight)
    return clouds === undefined ? shown : shown.mul(clouds.diffuse)
  }

  /** Light of the sky as layers before the fog show it. */
  #shown(light: Vec4): Vec4 {
    const layers: readonly SkyLayer[] = this.#atmosphere?.layers ?? []
    return layers
      .slice(0, Math.max(layers.indexOf(this), 0))
      .reduce((sky, layer) => layer.skyLight?.(sky) ?? sky, light)
  }

  /** Optical depth up to a distance [m]. */
  #depth(distance: Float): Float {
    const root = distance.mul(this.#density)
    return root.mul(root).min(80).toConst()
  }
}

/** Light of the sky at a ray's azimuth, just above the horizon if the ray is lower, for unit irradiance [1/sr]. */
function raisedSky({ view, cosView: below, cosViewLight: belowLight }: LayerRay): {
  light: Vec4
  cosView: Float
  cosViewLight: Float
} {
  const { viewpoint, volume } = view
  const cosView = below.max(viewpoint.cosHorizon.add(HORIZON_MARGIN)).min(1).toConst() as Float
  const sine = (cosine: Float): Float => cosine.mul(cosine).oneMinus().max(0).sqrt()
  const scale = sine(cosView).div(sine(below).max(1e-4))
  const cosViewLight = cosView
    .mul(viewpoint.cosLight)
    .add(belowLight.sub(below.mul(viewpoint.cosLight)).mul(scale))
    .clamp(-1, 1)
    .toConst() as Float
  const isGround = float(0).greaterThan(1) as Bool
  const ray = viewRay(viewpoint, cosView, isGround)
  const light = sampleSky(view.air.uniforms, volume, viewpoint, ray, cosViewLight)
  return { light, cosView, cosViewLight }
}

/** Sine of an angle above the horizon, about a pixel. */
const HORIZON_MARGIN = 1e-3

/** Fog by distance alone: see {@link DistanceFog}. */
export const distanceFog = (options?: DistanceFogOptions): DistanceFog => new DistanceFog(options)
