import { If, float, renderGroup, uniform, vec4 } from 'three/tsl'
import { setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkFade, checkRange } from '../check'
import type { Sightline, SkyLayer, Veil } from '../view/SkyLayer'
import { aimAt, sampleSky } from '../skyVolume/tsl/skyVolume'
import type { Bool, Float } from '../tsl-types'

/** Options of {@link DistanceFog}. */
export interface DistanceFogOptions {
  /** Of three's `FogExp2`: what is at 1/density has e⁻¹ of its light left, ≥ 0 [1/m]. */
  density?: number
  /** Altitudes of the camera between which the fog fades away, rising [m]. */
  fade?: readonly [number, number]
}

/**
 * Fog by distance alone, exp(−(density × distance)²) as three's `FogExp2`, in the light of the sky: what is
 * far away takes the colour that the sky has behind it at the horizon, and so vanishes into it at any time
 * of the day. It hides where a scene ends. The sky itself stays clear.
 *
 * ```ts
 * atmosphere.add(distanceFog({ density: 1 / 4000 }))
 * ```
 */
export class DistanceFog implements SkyLayer {
  #value = 1e-4
  #fade: readonly [number, number] = [5000, 15_000]
  #version = 0
  readonly #density = uniform(0).setGroup(renderGroup)

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

  veil({ view, cosView, cosViewSun, distance }: Sightline, air: Veil): Veil {
    if (distance === undefined) return air
    const depth = vec4(air.depth).toVar()
    const light = vec4(air.light).toVar()
    If(this.#density.greaterThan(0), () => {
      const { uniforms } = view.air
      const { eye, source } = view
      // The same azimuth, a little above the horizon where the way leads lower.
      const cosRaised = cosView.max(eye.cosHorizon.add(CLEARANCE)).min(1).toConst() as Float
      const sine = (cosine: Float): Float => cosine.mul(cosine).oneMinus().max(0).sqrt()
      const turned = sine(cosRaised).div(sine(cosView).max(1e-4))
      const cosRaisedSun = cosRaised
        .mul(eye.cosSun)
        .add(cosViewSun.sub(cosView.mul(eye.cosSun)).mul(turned))
        .clamp(-1, 1)
        .toConst() as Float
      const isGround = float(0).greaterThan(1) as Bool
      const sky = sampleSky(
        uniforms,
        view.volume,
        eye,
        aimAt(eye, cosRaised, isGround),
        cosRaisedSun
      )
      const color = sky.mul(source.irradiance)
      const root = distance.mul(this.#density)
      const fog = root.mul(root).min(80).toConst()
      const through = fog.negate().exp().toConst()
      light.assign(air.light.mul(through).add(color.mul(through.oneMinus())))
      depth.addAssign(fog)
    })
    return { depth: depth, light: light }
  }
}

/** Sine of an angle above the horizon, about that of a pixel. */
const CLEARANCE = 1e-3

/** Fog by distance alone: see {@link DistanceFog}. */
export const distanceFog = (options?: DistanceFogOptions): DistanceFog => new DistanceFog(options)
