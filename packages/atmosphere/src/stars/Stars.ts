import { DataTexture, FloatType, NearestFilter, RGBAFormat, RGFormat, Vector4 } from 'three'
import type { Matrix4 } from 'three'
import { checkBoolean, checkNonNegative, checkOptions, fail, setOptions } from '@welkin/geo'
import type { AtmosphereView } from '../view/AtmosphereView'
import { checkOrientation } from '../check'
import { CelestialFrame } from '../night/CelestialFrame'
import type { SkyLayer, SkyRay } from '../view/SkyLayer'
import { COLOR_STEPS, ENTRY_COLUMNS, STAR_LEVELS, starCells } from './starCells'
import type { Star } from './starCode'
import { MAGNITUDE_ZERO_ILLUMINANCE, starIrradiance } from './starColor'
import { starField, type StarTextures } from './tsl/starField'
import type { Vec4 } from '../tsl-types'
import { vec4Array } from '../tsl-types'
import { If, renderGroup, uniform } from 'three/tsl'

/** Options of {@link Stars}. */
export interface StarsOptions {
  /** What is drawn; by default the bright stars, which only `stars()` adds to a bundle. */
  catalogue?: readonly Star[]
  /** Leaves the drawing to `starsOverlay`, after post-processing. Default false. */
  overlay?: boolean
  /** Rotation from the stars' frame to ECEF; by default what the atmosphere's date makes it. */
  orientation?: Matrix4 | null
  /** Multiplies the physical brightness, finite, ≥ 0, default 1. */
  intensity?: number
}

/**
 * Fixed stars: points of light that are as bright as their magnitudes say, dimmed and reddened by the
 * air that they are seen through.
 *
 * ```ts
 * atmosphere.add(stars())
 * ```
 *
 * A star covers about a pixel whatever the picture's size, and its pixels add up to its illuminance: the
 * finer the picture, the brighter the star against the sky, as in a telescope. By day it is there, but
 * the sky is a thousand times as bright. Places are those of J2000 turned by precession, nutation and
 * the Earth's rotation; proper motion, aberration (20″) and refraction (34′ at the horizon, nothing
 * else of the sky has it) are left out.
 */
export class Stars implements SkyLayer {
  /** For type testing. */
  readonly isStars = true
  readonly isAdditive = true
  /** What is drawn. */
  readonly catalogue: readonly Star[]
  /** Whether `starsOverlay` draws them and the sky does not. */
  readonly overlay: boolean
  #intensity = 1
  readonly #frame = new CelestialFrame()
  readonly #palette = vec4Array(Array.from({ length: COLOR_STEPS.count }, () => new Vector4()))
  readonly #textures: StarTextures
  /** A hundred times the irradiance of the brightest star, over `solarIrradiance`. */
  readonly #brightest = uniform(0).setGroup(renderGroup)
  #paletteOf = ''

  /** @throws If a star lacks a finite number, or an option is of the wrong kind. */
  constructor(options: StarsOptions & { catalogue: readonly Star[] }) {
    checkOptions('Stars', options, 'catalogue', 'overlay', 'orientation', 'intensity')
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
      cells: dataTexture('Stars.cells', cells, STAR_LEVELS[0].cells, RGFormat),
      entries: dataTexture('Stars.entries', entries, ENTRY_COLUMNS, RGBAFormat)
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

  /** Multiplies the physical brightness, finite, ≥ 0. */
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
    if (state === this.#paletteOf) return
    this.#paletteOf = state
    const illuminance = MAGNITUDE_ZERO_ILLUMINANCE * this.intensity
    const magnitude = this.catalogue.reduce((least, star) => Math.min(least, star.magnitude), 9)
    const [, green] = starIrradiance(parameters, 0, illuminance * 10 ** (-0.4 * magnitude))
    this.#brightest.value = 100 * green
    this.#palette.array.forEach((color, step) => {
      const colorIndex = COLOR_STEPS.min + step * COLOR_STEPS.step
      color.fromArray(starIrradiance(parameters, colorIndex, illuminance))
    })
  }

  /** Light of the stars in a direction, above the air [1/sr]. */
  light(ray: SkyRay): Vec4 {
    const direction = this.#frame.turn(ray.direction).toConst()
    return starField(this.#textures, this.#palette, direction, ray.pixel)
  }

  beyond(ray: SkyRay, farther: Vec4): Vec4 {
    if (this.overlay) return farther
    const light = farther.toVar()
    // By day even the brightest star is less than a hundredth of the sky.
    const drowns = ray.pixel.mul(ray.pixel).mul(ray.airlight.y)
    If(drowns.lessThan(this.#brightest), () => {
      light.addAssign(this.light(ray))
    })
    return light
  }

  dispose(): void {
    this.#textures.cells.dispose()
    this.#textures.entries.dispose()
  }
}

function dataTexture(
  name: string,
  texels: Float32Array<ArrayBuffer>,
  width: number,
  format: typeof RGFormat | typeof RGBAFormat
): DataTexture {
  const rows = texels.length / width / (format === RGFormat ? 2 : 4)
  const made = new DataTexture(texels, width, rows, format, FloatType)
  made.name = name
  made.minFilter = made.magFilter = NearestFilter
  made.needsUpdate = true
  return made
}
