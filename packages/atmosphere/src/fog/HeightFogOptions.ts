import { fail } from '@welkin/geo'
import { checkFade, checkRange, checkSpectrum, withDefaults } from '../check'
import type { ScatteringPhase } from '../optics/ScatteringPhase'
import type { Spectrum } from '../parameters/AtmosphereParameters'
import { checkSources, type LightSource } from '../view/LightSource'

/** Options of `HeightFog`. */
export interface HeightFogOptions {
  /** Extinction at the base, ≥ 0, default 0.01 [1/m]. Visibility is about 4/density. */
  density?: number
  /** Altitude over which the density falls to 1/e, in [0.1, 1e5], default 50 [m]. */
  falloff?: number
  /** Altitude at which the fog has its density, such as that of a valley's floor; default 0 [m]. */
  base?: number
  /** Single-scattering albedo of the droplets at the four wavelengths, in [0, 1], default 1. */
  albedo?: Spectrum
  /** Asymmetry g of the droplets' phase function, in [0, 0.95], default 0.75; without effect if there are `droplets`. */
  asymmetry?: number
  /**
   * Droplets of a size, `droplets({ radius: 8 })`, with fogbow, glory and corona; shared, not owned. Null,
   * the default, for the smooth phase function of `asymmetry`.
   */
  droplets?: ScatteringPhase | null
  /** Light sources besides the sun, such as the moon's `source`; default none. */
  sources?: readonly LightSource[]
  /** Altitudes of the camera between which the fog fades away, rising; default [5000, 15,000] [m]. */
  fade?: readonly [number, number]
}

export const DEFAULTS: Required<HeightFogOptions> = {
  density: 0.01,
  falloff: 50,
  base: 0,
  albedo: [1, 1, 1, 1],
  asymmetry: 0.75,
  droplets: null,
  sources: [],
  fade: [5000, 15_000]
}

/** Checked options; undefined ones stay as they were. */
export function checked(
  before: Required<HeightFogOptions>,
  given: HeightFogOptions
): Required<HeightFogOptions> {
  const options = withDefaults('HeightFog', before, given)
  const { density, falloff, base, albedo, asymmetry, droplets, sources, fade } = options
  checkRange('HeightFog', 'density', density, 0, 100)
  checkRange('HeightFog', 'falloff', falloff, 0.1, 1e5)
  checkRange('HeightFog', 'base', base, -1e5, 1e6)
  checkRange('HeightFog', 'asymmetry', asymmetry, 0, 0.95)
  checkSpectrum('HeightFog', 'albedo', albedo, 1)
  checkSources('HeightFog', sources)
  checkFade('HeightFog', fade)
  if (droplets !== null && typeof droplets?.phase !== 'function') {
    fail('HeightFog', 'droplets must be droplets() or null', droplets)
  }
  return { ...options, albedo: [...albedo], sources: [...sources], fade: [...fade] }
}
