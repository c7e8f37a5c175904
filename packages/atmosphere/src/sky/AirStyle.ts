import { MathUtils, Vector4 } from 'three'
import { If, renderGroup, uniform, vec4 } from 'three/tsl'
import { checkNonNegative, setOptions } from '@welkin/geo'
import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { luminanceOf } from '../parameters/photometry'
import type { AtmosphereView } from '../view/AtmosphereView'
import type { LayerRay, SkyLayer } from '../view/SkyLayer'
import type { MediumSegment } from '../skyVolume/tsl/skyVolume'
import type { Vec4 } from '../tsl-types'
import { denserAir, saturated } from './tsl/airStyle'

/** Luminance of light that is even at the four wavelengths, in parts of the whole [–]. */
function luminousShares(parameters: AtmosphereParameters): number[] {
  const luminances = [0, 1, 2, 3].map(i =>
    luminanceOf(
      parameters,
      [0, 1, 2, 3].map(k => (k === i ? 1 : 0))
    )
  )
  const sum = luminances.reduce((total, value) => total + value, 0) || 1
  return luminances.map(value => value / sum)
}

/** Options of {@link AirStyle}. */
export interface AirStyleOptions {
  /** See {@link AirStyle.haze}; by default 1. */
  haze?: number
  /** See {@link AirStyle.twilightSaturation}; by default 1. */
  twilightSaturation?: number
}

const SETTINGS = ['haze', 'twilightSaturation'] as const

/** Elevations of the sun between which twilight counts in full, and outside of which it counts not at all [°]. */
const TWILIGHT = [-12, 2] as const
const NO_TWILIGHT = [-18, 10] as const

/**
 * Artistic factors on the air: strength of haze and colour of twilight. At 1, the default, nothing changes, bit for bit.
 *
 * ```ts
 * atmosphere.add(airStyle({ haze: 0.5, twilightSaturation: 1.3 })) // before fogs
 * ```
 *
 * They act on the picture alone, and on environment maps: lights and `skyIlluminanceAt` stay physical. Add it before
 * fogs, which have densities of their own and keep them if they come later; `distanceFog` has the sky's colours. Light shafts take what the air would
 * lose without it: give them a `strength` to match. An `AtmosphereShell` has no such factors.
 */
export class AirStyle implements SkyLayer {
  #haze = 1
  #twilightSaturation = 1
  #version = 0
  /** Parameters that the luminous shares are of, and their version. */
  #parameters: AtmosphereParameters | null = null
  #parametersVersion = -1
  readonly #strength = uniform(1).setGroup(renderGroup)
  readonly #saturation = uniform(1).setGroup(renderGroup)
  readonly #luminous = uniform(new Vector4()).setGroup(renderGroup)

  /** @throws If an option is unknown or out of range. */
  constructor(options: AirStyleOptions = {}) {
    this.set(options)
    this.#version = 0
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: AirStyleOptions): this {
    return setOptions('AirStyle', this, settings, ...SETTINGS)
  }

  /**
   * Factor on the optical depth of the air in front of the scene and of clouds, finite, ≥ 0 [–]: 0 takes haze away, 2
   * has twice as much. The sky behind stays as it is; `turbidity` of the parameters changes both.
   */
  get haze(): number {
    return this.#haze
  }

  set haze(value: number) {
    checkNonNegative('AirStyle', 'haze', value)
    if (value !== this.#haze) this.#version++
    this.#haze = value
  }

  /**
   * Factor on the saturation of the air's light while the sun is near the camera's horizon, finite, ≥ 0 [–]: 0 is grey, of
   * the same luminance. It counts in full with the sun from 2° up to 12° down, and not at all from 10° up or 18° down.
   */
  get twilightSaturation(): number {
    return this.#twilightSaturation
  }

  set twilightSaturation(value: number) {
    checkNonNegative('AirStyle', 'twilightSaturation', value)
    if (value !== this.#twilightSaturation) this.#version++
    this.#twilightSaturation = value
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  update({ atmosphere: { parameters }, up, lightDirection }: AtmosphereView): void {
    const elevation = MathUtils.radToDeg(Math.asin(MathUtils.clamp(up.dot(lightDirection), -1, 1)))
    const share =
      MathUtils.smoothstep(elevation, NO_TWILIGHT[0], TWILIGHT[0]) *
      (1 - MathUtils.smoothstep(elevation, TWILIGHT[1], NO_TWILIGHT[1]))
    this.#strength.value = this.#haze
    this.#saturation.value = 1 + (this.#twilightSaturation - 1) * share
    if (parameters === this.#parameters && parameters.version === this.#parametersVersion) return
    this.#parameters = parameters
    this.#parametersVersion = parameters.version
    this.#luminous.value.fromArray(luminousShares(parameters))
  }

  medium({ distance }: LayerRay, air: MediumSegment): MediumSegment {
    const depth = vec4(air.depth).toVar()
    const radiance = vec4(air.radiance).toVar()
    if (distance !== undefined) {
      If(this.#strength.notEqual(1), () => {
        const denser = denserAir({ depth, radiance }, this.#strength)
        radiance.assign(denser.radiance)
        depth.assign(denser.depth)
      })
    }
    return { depth, radiance: this.skyLight(radiance) }
  }

  skyLight(light: Vec4): Vec4 {
    const tinted = vec4(light).toVar()
    If(this.#saturation.notEqual(1), () => {
      tinted.assign(saturated(tinted, this.#luminous, this.#saturation))
    })
    return tinted
  }
}

/** Artistic factors on the air: see {@link AirStyle}. */
export const airStyle = (options?: AirStyleOptions): AirStyle => new AirStyle(options)
