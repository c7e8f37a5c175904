import { Vector4 } from 'three'
import { If, float, renderGroup, uniform, vec4 } from 'three/tsl'
import { checkNonNegative, setOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkRange, checkSpectrum } from '../check'
import { DROWNS, type HazeLine, type SkyLayer, type SkyRay } from '../view/SkyLayer'
import { ofLuminance } from '../stars/starColor'
import { glowGains, overheadGain } from './tsl/airglow'
import type { Bool, Float, Vec4 } from '../tsl-types'
import type { ViewUniforms } from '../view/ViewUniforms'

/** Options of {@link Airglow}. */
export interface AirglowOptions {
  /** Luminance straight through the layer, ≥ 0 [cd/m²]. */
  luminance?: number
  /** Altitude of the layer's middle, in [1, 1e7] [m]. */
  altitude?: number
  /** Standard deviation of its emission over altitude, in [1, 1e6] [m]. */
  width?: number
  /** Spectral radiance at the four wavelengths, of which only the ratios count. */
  spectrum?: Spectrum
  /** Multiplies the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

const SETTINGS = ['luminance', 'altitude', 'width', 'spectrum', 'intensity'] as const

/** The green line of oxygen at 557.7 nm, the sodium lines at 589 nm, and a continuum. */
const GREENISH: Spectrum = [0.76, 1.06, 1.05, 0.68]

/**
 * Irradiance of a level plane over π times the radiance straight through the layer, with no air:
 * 2 (1 − √(1 − a))/a, a = (R/(R + 96 km))² of the Earth.
 */
const DOME = 1.71

/**
 * Radiance in the air of light that it scattered from the layer, over that straight through the layer:
 * the mean over all directions of a dome that is {@link DOME} times as bright, and of dark ground.
 */
const SCATTERED = DOME / 2

/** Standard deviations below its middle from where the layer is as thin as a shell, within 0.4 %. */
const MARGIN = 10

/**
 * Airglow: the upper air's own light. From the ground a faint even light that brightens towards the
 * horizon; from orbit a thin greenish line above the limb.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars(), airglow())
 * ```
 *
 * A Gaussian layer at 96 km with a standard deviation of 4 km. By default 1e-4 cd/m² at the zenith
 * (22.6 magnitudes per square second of arc), as in years of a quiet sun; together with stars and the
 * Milky Way's faint light a moonless sky has about 22. The air below dims the layer and scatters its
 * light, by an estimate that takes light from all of the sky for even. Add it last: it is nearer than
 * anything else in the sky.
 */
export class Airglow implements SkyLayer {
  readonly isAdditive = true
  #luminance = 1e-4
  #spectrum: Spectrum = GREENISH
  readonly #layer = {
    altitude: uniform(96_000).setGroup(renderGroup),
    width: uniform(4000).setGroup(renderGroup)
  }
  /** Radiance straight through the layer, over `solarIrradiance`. */
  readonly #radiance = uniform(new Vector4()).setGroup(renderGroup)
  /** Green light of the air that hides it. */
  readonly #drowns = uniform(0).setGroup(renderGroup)
  /** 0 where all of the layer is far above the eye, else 1. */
  readonly #isAround = uniform(0).setGroup(renderGroup)
  #intensity = 1
  #version = 0

  /** @throws If an option is out of range. */
  constructor(options: AirglowOptions = {}) {
    this.set(options)
    this.#version = 0
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or out of range; then nothing has changed.
   */
  set(settings: AirglowOptions): this {
    return setOptions('Airglow', this, settings, ...SETTINGS)
  }

  /** Luminance straight through the layer, in [0, 1e9] [cd/m²]. */
  get luminance(): number {
    return this.#luminance
  }

  set luminance(value: number) {
    checkRange('Airglow', 'luminance', value, 0, 1e9)
    this.#luminance = value
    this.#version++
  }

  /** Altitude of the layer's middle, in [1, 1e7] [m]. */
  get altitude(): number {
    return this.#layer.altitude.value
  }

  set altitude(value: number) {
    checkRange('Airglow', 'altitude', value, 1, 1e7)
    this.#layer.altitude.value = value
    this.#version++
  }

  /** Standard deviation of its emission over altitude, in [1, 1e6] [m]. */
  get width(): number {
    return this.#layer.width.value
  }

  set width(value: number) {
    checkRange('Airglow', 'width', value, 1, 1e6)
    this.#layer.width.value = value
    this.#version++
  }

  /** Spectral radiance at the four wavelengths, of which only the ratios count. */
  get spectrum(): Spectrum {
    return this.#spectrum
  }

  set spectrum(value: Spectrum) {
    checkSpectrum('Airglow', 'spectrum', value, 1e9)
    this.#spectrum = [...value]
    this.#version++
  }

  /** Multiplies the physical brightness, finite, ≥ 0. */
  get intensity(): number {
    return this.#intensity
  }

  set intensity(value: number) {
    checkNonNegative('Airglow', 'intensity', value)
    if (value !== this.#intensity) this.#version++
    this.#intensity = value
  }

  /** See {@link SkyLayer.version}. */
  get version(): number {
    return this.#version
  }

  update({ atmosphere: { parameters }, height }: AtmosphereView): void {
    const values = this.#spectrum.map((value, i) => value / (parameters.solarIrradiance[i] || 1))
    const luminance = this.luminance * this.intensity
    this.#radiance.value.fromArray(ofLuminance(parameters, values, luminance))
    this.#drowns.value = this.#radiance.value.y * DROWNS
    const { altitude, width } = this.#layer
    this.#isAround.value = height < altitude.value - MARGIN * width.value ? 0 : 1
  }

  #gains(view: ViewUniforms, cosView: Float, distance: Float | null): { down: Float; up: Float } {
    const { bottomRadius } = view.air.uniforms
    return glowGains(this.#layer, view.height, cosView, bottomRadius, distance)
  }

  /** By day it is less than a thousandth of the sky. */
  #isSeen(airlight: Vec4): Bool {
    return airlight.y.lessThan(this.#drowns)
  }

  /** The layer beyond the air below it. */
  beyond({ view, cosView, airlight }: SkyRay, farther: Vec4): Vec4 {
    const light = farther.toVar()
    If(this.#isSeen(airlight), () => {
      const gain = float(0).toVar()
      If(this.#isAround.equal(0), () => {
        const { bottomRadius } = view.air.uniforms
        gain.assign(overheadGain(this.#layer, view.height, cosView, bottomRadius))
      }).Else(() => {
        gain.assign(this.#gains(view, cosView, null).up)
      })
      light.addAssign(this.#radiance.mul(gain))
    })
    return light
  }

  /** The layer in front of that air, from above. */
  glow({ view, cosView, airlight }: SkyRay, without: Vec4): Vec4 {
    const light = without.toVar()
    If(this.#isAround.greaterThan(0).and(this.#isSeen(airlight)), () => {
      light.addAssign(this.#radiance.mul(this.#gains(view, cosView, null).down))
    })
    return light
  }

  /** Its light scattered in the air, and the ground in it. */
  below({ view, hitsGround, airlight }: SkyRay): ReturnType<NonNullable<SkyLayer['below']>> {
    return {
      isSeen: this.#isSeen(airlight),
      // The ground's through the air, and the air's.
      light: through => {
        const ground = view.air.uniforms.groundAlbedo.mul(hitsGround.select(DOME, 0))
        return vec4(ground.sub(SCATTERED).mul(through).add(SCATTERED).mul(this.#radiance))
      }
    }
  }

  haze({ view, cosView, distance }: HazeLine, without: Vec4): Vec4 {
    const light = without.toVar()
    // From below there is none of it in front of anything.
    If(this.#isAround.greaterThan(0), () => {
      const { down, up } = this.#gains(view, cosView, distance)
      light.addAssign(this.#radiance.mul(down.add(up)))
    })
    return light
  }
}

/** The upper air's own light: see {@link Airglow}. */
export const airglow = (options?: AirglowOptions): Airglow => new Airglow(options)
