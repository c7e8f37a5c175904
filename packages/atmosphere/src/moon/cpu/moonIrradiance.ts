import type { Spectrum } from '../../parameters/AtmosphereParameters'
import { moonPhaseLaw } from './moonPhaseLaw'

/** Mean radius of the moon [m]. */
export const MOON_RADIUS = 1_737_400

/** Mean distance of the moon from the Earth, for which the phase law holds [m]. */
export const MOON_DISTANCE = 384_400_000

/**
 * Irradiance by the full moon over that by the sun: V = −12.73 against −26.74.
 *
 * @see Krisciunas & Schaefer 1991, PASP 103, 1033, eq. 9; Willmer 2018, ApJS 236, 47,
 *   table 3 (the sun)
 */
const FULL_MOON_IRRADIANCE = 10 ** (-0.4 * (26.74 - 12.73))

/**
 * Colour of moonlight relative to sunlight at the four wavelengths, 1 in luminance: B − V is 0.92
 * against 0.65, and reflectance keeps rising, more slowly, into the red.
 *
 * @see Allen 1976, Astrophysical Quantities, §66; Kieffer & Stone 2005, AJ 129, 2887, eq. 10
 */
export const MOON_COLOR: Spectrum = [0.773, 0.931, 1.01, 1.119]

/** Colour of light from the Earth, blue sky and white clouds. @see Goode et al. 2001, GRL 28, pp. 1671–1674 */
const EARTH_COLOR: Spectrum = [1.3, 1.07, 0.97, 0.9]

/** Geometric albedo of the Earth. @see Allen 1976, §66 */
const EARTH_ALBEDO = 0.367

/**
 * Irradiance by the moon above the air, over that by the sun; one value per wavelength.
 *
 * @param angle - Phase angle, in [0, π] [rad].
 * @param distance - Observer to moon [m].
 * @param radius - Radius of the moon [m].
 */
export function moonIrradiance(
  angle: number,
  distance = MOON_DISTANCE,
  radius = MOON_RADIUS
): Spectrum {
  const solidAngle = ((radius / MOON_RADIUS) * (MOON_DISTANCE / distance)) ** 2
  const light = FULL_MOON_IRRADIANCE * solidAngle * moonPhaseLaw(angle)
  return MOON_COLOR.map(color => color * light) as unknown as Spectrum
}

/**
 * Earthshine: irradiance of the moon's near side by its planet, over that by the sun; one value per
 * wavelength. The planet is a Lambertian sphere, full when the moon is new.
 *
 * @param angle - Phase angle of the moon, in [0, π] [rad].
 * @param distance - Moon to planet [m].
 * @param planetRadius - Radius of the planet [m].
 */
export function earthshine(angle: number, distance: number, planetRadius: number): Spectrum {
  const planetAngle = Math.PI - angle
  const phase = (Math.sin(planetAngle) + angle * Math.cos(planetAngle)) / Math.PI
  const light = EARTH_ALBEDO * (planetRadius / distance) ** 2 * Math.max(phase, 0)
  return EARTH_COLOR.map(color => color * light) as unknown as Spectrum
}
