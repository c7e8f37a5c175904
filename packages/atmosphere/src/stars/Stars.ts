import { DataTexture, FloatType, NearestFilter, RGBAFormat, RGFormat, Vector4 } from 'three'
import type { Matrix4 } from 'three'
import { checkBoolean, checkNonNegative, checkOptions, fail, setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkOrientation } from '../check'
import { CelestialFrame } from '../night/CelestialFrame'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { COLOR_STEPS, ENTRY_COLUMNS, STAR_LEVELS, starCells } from './starCells'
import type { Star } from './starEncoding'
import { starIlluminance, starIrradiance } from './starBrightness'
import { starField, type StarTextures } from './tsl/starField'
import type { Vec4 } from '../tsl-types'
import { vec4Array } from '../tsl-types'
import { If } from 'three/tsl'
import { number } from '../uniforms'

/** Light of the sky over that of the brightest star from which on no star is drawn. */
const MASKING_RATIO = 100

/** Options of {@link Stars}. */
export interface StarsOptions {
  /** Stars to draw; by default the bright ones, which only `stars()` adds to a bundle. */
  catalogue?: readonly Star[]
  /** Leaves the drawing to `starsOverlay`, after post-processing. Default false. */
  overlay?: boolean
  /** Rotation from the stars' frame (J2000) to ECEF; by default it follows the atmosphere's date. */
  orientation?: Matrix4 | null
  /** Factor on the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

/** Names of all options. */
export const STARS_OPTIONS = ['catalogue', 'overlay', 'orientation', 'intensity'] as const

/**
 * Fixed stars: points of light with the brightness of their magnitudes, dimmed and reddened by the air in
 * front of them.
 *
 * ```ts
 * atmosphere.add(stars())
 * ```
 *
 * A star covers about one pixel at any resolution, and its pixels add up to its illuminance: the finer
 * the picture, the brighter the star against the sky, as in a telescope. Positions are those of J2000,
 * rotated by precession, nutation and the Earth's rotation. Proper motion, aberration (20″) and refraction
 * (34′ at the horizon; nothing else in the sky has it) are left out.
 */
export class Stars implements SkyLayer {
  /** Type tag: true. */
  readonly isStars = true
  readonly isAdditive = true
  /** Stars that are drawn. */
  readonly catalogue: readonly Star[]
  /** `starsOverlay` draws them, instead of the sky. */
  readonly overlay: boolean
  #intensity = 1
  readonly #frame = new CelestialFrame()
  readonly #palette = vec4Array(Array.from({ length: COLOR_STEPS.count }, () => new Vector4()))
  readonly #textures: StarTextures
  /** Light of the sky in one pixel that masks even the brightest star, over `solarIrradiance`. */
  readonly #maskingIrradiance = number()
  #paletteKey = ''

  /** @throws If a star lacks a finite number, or an option is of the wrong kind. */
  constructor(options: StarsOptions & { catalogue: readonly Star[] }) {
    checkOptions('Stars', options, ...STARS_OPTIONS)
    const { catalogue, overlay = false, ...settings } = options
    checkBoolean('Stars', 'overlay', overlay)
    if (!Array.isArray(catalogue)) fail('Stars', 'catalogue must be an array of stars', catalogue)
    catalogue.forEach((star, i) => {
      for (const name of ['ascension', 'declination', 'magnitude', 'colorIndex'] as const) {
        const value = star?.[name]
        if (!Number.isFinite(value)) fail('Stars', `${name} of star ${i} must be finite`, value)
      }
    })
    this.catalogue = catalogue
    this.overlay = overlay
    this.set(settings)
    const { cells, entries } = starCells(catalogue)
    this.#textures = {
      cells: dataTexture('Welkin.Stars.cells', cells, STAR_LEVELS[0].cells, RGFormat),
      entries: dataTexture('Welkin.Stars.entries', entries, ENTRY_COLUMNS, RGBAFormat)
    }
  }

  /**
   * Changes some settings.
   *
   * @throws If one is unknown or of the wrong kind; then nothing has changed.
   */
  set(settings: Pick<StarsOptions, 'orientation' | 'intensity'>): this {
    return setOptions('Stars', this, settings, 'orientation', 'intensity')
  }

  /** Factor on the physical brightness, finite, ≥ 0. */
  get intensity(): number {
    return this.#intensity
  }

  set intensity(value: number) {
    checkNonNegative('Stars', 'intensity', value)
    this.#intensity = value
  }

  /** Rotation from the stars' frame to ECEF; null to follow the atmosphere's date. */
  get orientation(): Matrix4 | null {
    return this.#frame.orientation
  }

  set orientation(value: Matrix4 | null) {
    checkOrientation('Stars', value)
    this.#frame.orientation = value
  }

  update(view: AtmosphereView): void {
    this.#frame.update(view)
    this.#updatePalette(view.atmosphere)
  }

  #updatePalette({ parameters }: AtmosphereView['atmosphere']): void {
    const { wavelengths, solarIrradiance, spectralToXYZ } = parameters
    const state = [this.intensity, wavelengths, solarIrradiance, spectralToXYZ].join(' ')
    if (state === this.#paletteKey) return
    this.#paletteKey = state
    const brightest = this.catalogue.reduce((least, star) => Math.min(least, star.magnitude), 9)
    const illuminance = (magnitude: number): number => this.intensity * starIlluminance(magnitude)
    const [, green] = starIrradiance(parameters, 0, illuminance(brightest))
    this.#maskingIrradiance.value = MASKING_RATIO * green
    this.#palette.array.forEach((color, step) => {
      const colorIndex = COLOR_STEPS.min + step * COLOR_STEPS.step
      color.fromArray(starIrradiance(parameters, colorIndex, illuminance(0)))
    })
  }

  /** Radiance of the stars above the air [1/sr]. */
  light(ray: SkyRay): Vec4 {
    const direction = this.#frame.fromMapped(ray.direction).toConst()
    return starField(this.#textures, this.#palette, direction, ray.pixel)
  }

  background(ray: SkyRay, farther: Vec4): Vec4 {
    if (this.overlay) return farther
    const light = farther.toVar()
    // By day the loop over stars is skipped.
    const skyInPixel = ray.pixel.mul(ray.pixel).mul(ray.airlight.y)
    If(skyInPixel.lessThan(this.#maskingIrradiance), () => {
      light.addAssign(this.light(ray))
    })
    return light
  }

  dispose(): void {
    this.#textures.cells.dispose()
    this.#textures.entries.dispose()
  }
}

/** Float texture without filtering. */
function dataTexture(
  name: string,
  texels: Float32Array<ArrayBuffer>,
  width: number,
  format: typeof RGFormat | typeof RGBAFormat
): DataTexture {
  const rows = texels.length / width / (format === RGFormat ? 2 : 4)
  const result = new DataTexture(texels, width, rows, format, FloatType)
  result.name = name
  result.minFilter = result.magFilter = NearestFilter
  result.needsUpdate = true
  return result
}
