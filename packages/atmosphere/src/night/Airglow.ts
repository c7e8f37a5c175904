import { If, float, vec4 } from 'three/tsl'
import { checkNonNegative, setOptions } from '@welkin/geo'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkRange, checkSpectrum } from '../check'
import { MASKING_RATIO, type PointRay, type SkyLayer, type SkyRay } from '../view/SkyLayer'
import { scaleToLuminance } from '../parameters/photometry'
import { layerInPixel, thinLayerVanRhijnFactor, vanRhijnFactors } from './tsl/airglow'
import type { Bool, Float, Vec4 } from '../tsl-types'
import type { ViewUniforms } from '../view/ViewUniforms'
import { number, vector4 } from '../uniforms'

/** Options of {@link Airglow}. */
export interface AirglowOptions {
  /** Luminance of the layer seen perpendicularly, in [0, 1e9], default 1e-4 [cd/m²]. */
  luminance?: number
  /** Altitude of the layer's middle, in [1, 1e7], default 96,000 [m]. */
  altitude?: number
  /** Standard deviation of its emission over altitude, in [1, 1e6], default 4000 [m]. */
  width?: number
  /** Spectral radiance at the four wavelengths, default greenish; only the ratios count. */
  spectrum?: Spectrum
  /** Factor on the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

/** Options that may change later. */
const SETTINGS = ['luminance', 'altitude', 'width', 'spectrum', 'intensity'] as const

/** Spectrum of the green line of oxygen at 557.7 nm, the sodium lines at 589 nm, and a continuum. */
const GREENISH: Spectrum = [0.76, 1.06, 1.05, 0.68]

/**
 * Irradiance of a level plane without air, over π times the zenith radiance of the layer:
 * 2 (1 − √(1 − a))/a with a = (R/(R + 96 km))² of the Earth.
 */
const DOME_IRRADIANCE = 1.71

/**
 * Radiance of airglow scattered by opaque air, over the zenith radiance of the layer: the mean over all
 * directions of a dome of {@link DOME_IRRADIANCE} above and dark ground below.
 */
const SCATTERED_RADIANCE = DOME_IRRADIANCE / 2

/** Standard deviations below the layer from where a thin shell stands for it, within 0.4 %. */
const THIN_LAYER_SIGMAS = 10

/**
 * Airglow, the upper atmosphere's own light: from the ground a faint even glow that brightens towards the
 * horizon, from orbit a thin greenish line above the limb.
 *
 * ```ts
 * atmosphere.add(milkyWay(), stars(), airglow())
 * ```
 *
 * The layer is a Gaussian in altitude, at 96 km with a standard deviation of 4 km. Its default luminance
 * of 1e-4 cd/m² at the zenith (22.6 magnitudes per square arc second) is that of years of a quiet sun;
 * with stars and Milky Way a moonless sky has about 22. The air below dims the layer and scatters its
 * light, estimated as if the sky were evenly bright. Add it last: it is nearer than all else in the sky.
 */
export class Airglow implements SkyLayer {
  readonly isAdditive = true
  #luminance = 1e-4
  #spectrum: Spectrum = GREENISH
  readonly #layer = {
    altitude: number(96_000),
    width: number(4000)
  }
  /** Radiance of the layer seen perpendicularly, over `solarIrradiance` [1/sr]. */
  readonly #radiance = vector4()
  /** Radiance of the air in the green that masks the layer [1/sr]. */
  readonly #maskingRadiance = number()
  /** 0 where the camera is far below the layer, else 1. */
  readonly #isClose = number()
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

  /** Luminance of the layer seen perpendicularly, in [0, 1e9] [cd/m²]. */
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

  /** Spectral radiance at the four wavelengths; only the ratios count. */
  get spectrum(): Spectrum {
    return this.#spectrum
  }

  set spectrum(value: Spectrum) {
    checkSpectrum('Airglow', 'spectrum', value, 1e9)
    this.#spectrum = [...value]
    this.#version++
  }

  /** Factor on the physical brightness, finite, ≥ 0. */
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
    this.#radiance.value.fromArray(scaleToLuminance(parameters, values, luminance))
    this.#maskingRadiance.value = this.#radiance.value.y * MASKING_RATIO
    const { altitude, width } = this.#layer
    this.#isClose.value = height < altitude.value - THIN_LAYER_SIGMAS * width.value ? 0 : 1
  }

  #vanRhijnFactors(
    view: ViewUniforms,
    cosView: Float,
    distance: Float
  ): { down: Float; up: Float } {
    const { bottomRadius } = view.air.uniforms
    return vanRhijnFactors(this.#layer, view.height, cosView, bottomRadius, distance)
  }

  /** Van Rhijn factors of a pixel of the sky. */
  #skyFactors({ view, cosView, pixel }: SkyRay): { down: Float; up: Float } {
    const { air, height } = view
    const { bottomRadius } = air.uniforms
    const layer = layerInPixel(this.#layer, height, cosView, bottomRadius, pixel)
    return vanRhijnFactors(layer, height, cosView, bottomRadius, null)
  }

  /** False by day, when the sky masks the layer. */
  #isVisible(airlight: Vec4): Bool {
    return airlight.y.lessThan(this.#maskingRadiance)
  }

  /** Light of the layer where the ray leaves it upwards, beyond the air below it. */
  background(ray: SkyRay, farther: Vec4): Vec4 {
    const { view, cosView, airlight } = ray
    const light = farther.toVar()
    If(this.#isVisible(airlight), () => {
      const gain = float(0).toVar()
      If(this.#isClose.equal(0), () => {
        const { bottomRadius } = view.air.uniforms
        gain.assign(thinLayerVanRhijnFactor(this.#layer, view.height, cosView, bottomRadius))
      }).Else(() => {
        gain.assign(this.#skyFactors(ray).up)
      })
      light.addAssign(this.#radiance.mul(gain))
    })
    return light
  }

  /** Light of the layer in front of the air, where the ray enters it from above. */
  glow(ray: SkyRay, without: Vec4): Vec4 {
    const light = without.toVar()
    If(this.#isClose.greaterThan(0).and(this.#isVisible(ray.airlight)), () => {
      light.addAssign(this.#radiance.mul(this.#skyFactors(ray).down))
    })
    return light
  }

  /** Airglow scattered by the air and reflected by the ground. */
  below({ view, hitsGround, airlight }: SkyRay): ReturnType<NonNullable<SkyLayer['below']>> {
    return {
      isSeen: this.#isVisible(airlight),
      light: through => {
        // Ground × transmittance + scattered × (1 − transmittance).
        const ground = view.air.uniforms.groundAlbedo.mul(hitsGround.select(DOME_IRRADIANCE, 0))
        return vec4(
          ground.sub(SCATTERED_RADIANCE).mul(through).add(SCATTERED_RADIANCE).mul(this.#radiance)
        )
      }
    }
  }

  inScatter({ view, cosView, distance }: PointRay, without: Vec4): Vec4 {
    const light = without.toVar()
    // Seen from below, the layer is behind everything.
    If(this.#isClose.greaterThan(0), () => {
      const { down, up } = this.#vanRhijnFactors(view, cosView, distance)
      light.addAssign(this.#radiance.mul(down.add(up)))
    })
    return light
  }
}

/** Airglow, the upper atmosphere's own light: see {@link Airglow}. */
export const airglow = (options?: AirglowOptions): Airglow => new Airglow(options)
