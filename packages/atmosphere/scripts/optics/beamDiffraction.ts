import { meanShadow, sideShare, type Prism } from './crystal'
import { CRYSTAL_RADII } from './discDiffraction'

/** Cosine of the angle at which light meets a side at the least deviation, of an index of 1.31. */
const COS_INCIDENCE = Math.cos(Math.asin(1.31 / 2))

/** Farthest that light is spread [°]: some 2 % of it goes farther. */
const REACH = 8

/** Beam that leaves crystals of a shape and size. */
export interface Beam {
  /** Width between the sides of 60° that make the halo of 22° [µm]. */
  readonly width: number
  /** Its light, over that of all beams. */
  readonly share: number
}

/**
 * Beams of the halo of 22°, for crystals with shadows as large as the discs of `discDiffraction`. At the least deviation a beam is as wide as a
 * side, as wide as the hexagon's radius, is seen along the light. Crystals with more of their surface in sides make more of the halo.
 *
 * @param prisms - Shapes that count alike.
 */
export function haloBeams(prisms: readonly Prism[]): Beam[] {
  const beams = CRYSTAL_RADII.flatMap(radius =>
    prisms.map(prism => ({
      width: radius * Math.sqrt(Math.PI / meanShadow(prism)) * COS_INCIDENCE,
      share: sideShare(prism)
    }))
  )
  const all = beams.reduce((sum, { share }) => sum + share, 0)
  return beams.map(({ width, share }) => ({ width, share: share / all }))
}

/**
 * Light at an angle from the middle of beams, by Fraunhofer's diffraction at a slit, per radian of the angle.
 *
 * @param radians - The angle.
 * @param wavelength - [µm].
 * @see Born & Wolf 1999, "Principles of optics", 7th ed., §8.5.1, eq. 4
 */
export function slitPattern(beams: readonly Beam[], radians: number, wavelength: number): number {
  return beams.reduce((sum, { width, share }) => {
    const u = (Math.PI * width * Math.sin(radians)) / wavelength
    const amplitude = Math.abs(u) < 1e-6 ? 1 : Math.sin(u) / u
    return sum + ((share * width) / wavelength) * amplitude ** 2
  }, 0)
}

/**
 * Phase function whose rays are beams with a width: they spread across the edges of the sides, towards the light and away from it.
 *
 * @param phase - Phase function at even angles, from the light to a quarter turn [1/sr].
 * @param from - Angle from which on it is spread; before it, it stays [°].
 * @param wavelength - [µm].
 */
export function spreadBeams(
  phase: readonly number[],
  from: number,
  beams: readonly Beam[],
  wavelength: number
): number[] {
  const step = 90 / (phase.length - 1)
  const toRadians = Math.PI / 180
  const reach = Math.round(REACH / step)
  const weights = Array.from({ length: 2 * reach + 1 }, (_, i) =>
    slitPattern(beams, (i - reach) * step * toRadians, wavelength)
  )
  const all = weights.reduce((sum, weight) => sum + weight)
  const last = phase.length - 1
  return phase.map((value, i) => {
    if (i * step < from) return value
    // Light between two angles is spread, not light per solid angle.
    const sum = weights.reduce((total, weight, n) => {
      const at = Math.min(i + n - reach, last)
      return total + weight * phase[at] * Math.sin(at * step * toRadians)
    }, 0)
    return sum / all / Math.sin(i * step * toRadians)
  })
}
