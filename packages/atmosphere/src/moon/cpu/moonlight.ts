import type { Spectrum } from '../../parameters/AtmosphereParameters'

/** Mean radius of the moon [m]. */
export const MOON_RADIUS = 1_737_400

/** Mean distance of the moon from the Earth, for which the phase law holds [m]. */
export const MOON_DISTANCE = 384_400_000

/**
 * Irradiance by the full moon over that by the sun, V = −12.73 against −26.74.
 *
 * @see Krisciunas & Schaefer 1991, PASP 103, 1033; Willmer 2018, ApJS 236, 47 (the sun)
 */
const FULL_MOON = 10 ** (-0.4 * (26.74 - 12.73))

/**
 * Colour of moonlight in sunlight: B − V is 0.92 against 0.65, and reflectance goes on rising, more
 * slowly, into the red. Its mean weighted by luminance is 1.
 *
 * @see Allen 1976, Astrophysical Quantities, §66; Kieffer & Stone 2005, AJ 129, 2887
 */
export const MOON_COLOR: Spectrum = [0.773, 0.931, 1.01, 1.119]

/** Colour of light from the Earth: blue sky and white clouds. Goode et al. 2001, GRL 28, 1671 */
const EARTH_COLOR: Spectrum = [1.3, 1.07, 0.97, 0.9]

/** Geometric albedo of the Earth. Allen 1976, §66 */
const EARTH_ALBEDO = 0.367

/** Beyond this phase angle nothing was measured, and light falls as the lit crescent does [rad]. */
const LARGEST_MEASURED = (150 * Math.PI) / 180

/** 10^(−0.4 Δm) of the phase law, with the phase angle in radians. */
function measuredPhaseLaw(angle: number): number {
  const degrees = (angle * 180) / Math.PI
  return 10 ** (-0.4 * (0.026 * degrees + 4e-9 * degrees ** 4))
}

/**
 * Light of a Lommel–Seeliger sphere, 1 when full: 1 − sin(α/2) tan(α/2) ln cot(α/4).
 *
 * @param angle - Phase angle α: between sun and observer, at the moon, in [0, π] [rad].
 * @see Hapke 2012, Theory of Reflectance and Emittance Spectroscopy, 2nd ed., §11.4
 */
export function lommelSeeligerPhase(angle: number): number {
  // Where the terms overflow or cancel, the limits.
  if (angle < 1e-9) return 1
  if (angle > Math.PI - 1e-5) return 0
  const half = angle / 2
  return 1 - Math.sin(half) * Math.tan(half) * Math.log(1 / Math.tan(half / 2))
}

/**
 * How bright the moon's ground is at a phase angle, over that of the same place when full, apart from
 * what a Lommel–Seeliger surface says: the steep rise towards the full moon.
 */
export function surfacePhase(angle: number): number {
  const measured = Math.min(angle, LARGEST_MEASURED)
  return measuredPhaseLaw(measured) / lommelSeeligerPhase(measured)
}

/**
 * Light of the moon at a phase angle over that of the full moon.
 *
 * Δm = 0.026 |α| + 4·10⁻⁹ α⁴, α in degrees; past 150° that of a crescent whose ground stays the same.
 * The opposition surge of the last degrees, where the Earth's shadow is not far, is left out.
 *
 * @param angle - α, in [0, π] [rad].
 * @see Krisciunas & Schaefer 1991, eq. 9, after Allen 1976
 */
export function moonPhaseLaw(angle: number): number {
  return surfacePhase(angle) * lommelSeeligerPhase(angle)
}

/**
 * Irradiance by the moon, without air in between, over that by the sun; one value per wavelength.
 *
 * @param angle - Phase angle, in [0, π] [rad].
 * @param distance - From the observer [m].
 * @param radius - Of the moon [m].
 */
export function moonIrradiance(
  angle: number,
  distance = MOON_DISTANCE,
  radius = MOON_RADIUS
): Spectrum {
  const size = ((radius / MOON_RADIUS) * (MOON_DISTANCE / distance)) ** 2
  const light = FULL_MOON * size * moonPhaseLaw(angle)
  return MOON_COLOR.map(color => color * light) as unknown as Spectrum
}

/**
 * Irradiance of the moon's near side by its planet over that by the sun, one value per wavelength.
 * The planet is a Lambertian sphere, full when the moon is new.
 *
 * @param angle - Phase angle of the moon, in [0, π] [rad].
 * @param distance - Between moon and planet [m].
 * @param planetRadius - [m].
 */
export function earthshine(angle: number, distance: number, planetRadius: number): Spectrum {
  const planetAngle = Math.PI - angle
  const phase = (Math.sin(planetAngle) + angle * Math.cos(planetAngle)) / Math.PI
  const light = EARTH_ALBEDO * (planetRadius / distance) ** 2 * Math.max(phase, 0)
  return EARTH_COLOR.map(color => color * light) as unknown as Spectrum
}
