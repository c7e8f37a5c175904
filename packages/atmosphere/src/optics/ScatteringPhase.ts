import type { Float, Vec4 } from '../tsl-types'

/** Directions that a phase function is asked for, as shader nodes. */
export interface ScatteringAngles {
  /** ν, cosine between the view ray and the light: that of the scattering angle. */
  readonly cosViewLight: Float
  /** Cosine between the view ray and the zenith. */
  readonly cosView: Float
  /** Cosine between the light and the zenith. */
  readonly cosLight: Float
}

/**
 * Phase function of particles with its fine structure, bows and rings, which only light that was scattered once shows:
 * {@link Droplets}.
 */
export interface ScatteringPhase {
  /** Asymmetry g, the mean cosine of the scattering angle. */
  readonly asymmetry: number
  /** Counts changes. */
  readonly version: number
  /** Part of the light scattered into a direction, at the four wavelengths [1/sr]; to be called inside of a shader function. */
  phase(angles: ScatteringAngles): Vec4
  /**
   * Phase function of light that was also diffracted on its path through a cloud; left out by particles whose diffraction is too narrow to
   * change anything.
   */
  diffracted?(angles: ScatteringAngles): Vec4
  /** Frees GPU memory. */
  dispose(): void
}
