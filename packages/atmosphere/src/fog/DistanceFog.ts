import { If, float, vec4 } from 'three/tsl'
import { setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkFade, checkRange } from '../check'
import type { LayerRay, SkyLayer } from '../view/SkyLayer'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import { sampleSky } from '../skyVolume/tsl/skyVolume'
import { viewRay } from '../skyVolume/tsl/viewRay'
import type { Bool, Float } from '../tsl-types'
import { number } from '../uniforms'

/** Options of {@link DistanceFog}. */
export interface DistanceFogOptions {
  /** Density as in three's `FogExp2`: at distance 1/density e⁻¹ of the light is left; in [0, 100] [1/m]. */
  density?: number
  /** Altitudes of the camera between which the fog fades away, rising [m]. */
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
  #value = 1e-4
  #fade: readonly [number, number] = [5000, 15_000]
  #version = 0
  readonly #density = number()

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

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  update(view: AtmosphereView): void {
    const [low, high] = this.fade
    const x = Math.min(Math.max((view.height - low) / (high - low), 0), 1)
    this.#density.value = this.density * (1 - x * x * (3 - 2 * x))
  }

  medium({ view, cosView, cosViewLight, distance }: LayerRay, air: MediumSegment): MediumSegment {
    if (distance === undefined) return air
    const depth = vec4(air.depth).toVar()
    const light = vec4(air.radiance).toVar()
    If(this.#density.greaterThan(0), () => {
      const { uniforms } = view.air
      const { viewpoint, source } = view
      // The same azimuth, raised to just above the horizon if the ray is lower.
      const cosRaised = cosView
        .max(viewpoint.cosHorizon.add(HORIZON_MARGIN))
        .min(1)
        .toConst() as Float
      const sine = (cosine: Float): Float => cosine.mul(cosine).oneMinus().max(0).sqrt()
      const scale = sine(cosRaised).div(sine(cosView).max(1e-4))
      const cosRaisedLight = cosRaised
        .mul(viewpoint.cosLight)
        .add(cosViewLight.sub(cosView.mul(viewpoint.cosLight)).mul(scale))
        .clamp(-1, 1)
        .toConst() as Float
      const isGround = float(0).greaterThan(1) as Bool
      const sky = sampleSky(
        uniforms,
        view.volume,
        viewpoint,
        viewRay(viewpoint, cosRaised, isGround),
        cosRaisedLight
      )
      const color = sky.mul(source.irradiance)
      const root = distance.mul(this.#density)
      const fog = root.mul(root).min(80).toConst()
      const through = fog.negate().exp().toConst()
      light.assign(air.radiance.mul(through).add(color.mul(through.oneMinus())))
      depth.addAssign(fog)
    })
    return { depth: depth, radiance: light }
  }
}

/** Sine of an angle above the horizon, about a pixel. */
const HORIZON_MARGIN = 1e-3

/** Fog by distance alone: see {@link DistanceFog}. */
export const distanceFog = (options?: DistanceFogOptions): DistanceFog => new DistanceFog(options)
