import type { AtmosphereParameters } from './AtmosphereParameters'

/** Maximum luminous efficacy, of light at 555 nm [lm/W]. */
const MAXIMUM_LUMINOUS_EFFICACY = 683

/**
 * Luminance or illuminance of light.
 *
 * @param spectrum - Radiance or irradiance at the four wavelengths, over `solarIrradiance`.
 * @returns [cd/m²] or [lx].
 */
export function luminanceOf(parameters: AtmosphereParameters, spectrum: readonly number[]): number {
  const luminousRow = parameters.spectralToXYZ[1]
  const { solarIrradiance } = parameters
  return spectrum.reduce(
    (sum, value, i) =>
      sum + MAXIMUM_LUMINOUS_EFFICACY * luminousRow[i] * solarIrradiance[i] * value,
    0
  )
}

/**
 * Light of the same colour with another luminance or illuminance.
 *
 * @param spectrum - Radiance or irradiance at the four wavelengths, over `solarIrradiance`.
 * @param luminance - [cd/m²], or illuminance [lx].
 */
export function scaleToLuminance(
  parameters: AtmosphereParameters,
  spectrum: readonly number[],
  luminance: number
): number[] {
  const scale = luminance / (luminanceOf(parameters, spectrum) || 1)
  return spectrum.map(value => value * scale)
}
