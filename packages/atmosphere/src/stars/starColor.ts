import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'

/** Illuminance by a star of magnitude 0 above the air [lx]. Allen, Astrophysical Quantities. */
export const MAGNITUDE_ZERO_ILLUMINANCE = 2.54e-6

/** Luminous efficacy of light at 555 nm [lm/W]. */
const MAXIMUM_EFFICACY = 683

/** Second radiation constant h c / k [nm K]. CODATA 2018. */
const SECOND_RADIATION = 1.438776877e7

/**
 * Temperature of a black body with that colour.
 *
 * @param colorIndex - B − V [mag].
 * @returns [K]
 * @see Ballesteros 2012, "New insights into black bodies", eq. 14
 */
export function colorTemperature(colorIndex: number): number {
  return 4600 * (1 / (0.92 * colorIndex + 1.7) + 1 / (0.92 * colorIndex + 0.62))
}

/** Illuminance or luminance of light that has these four values over `solarIrradiance`. */
export function luminanceOf(parameters: AtmosphereParameters, values: readonly number[]): number {
  const row = parameters.spectralToXYZ[1]
  const { solarIrradiance } = parameters
  return values.reduce(
    (sum, value, i) => sum + MAXIMUM_EFFICACY * row[i] * solarIrradiance[i] * value,
    0
  )
}

/** Scales four values over `solarIrradiance` to an illuminance [lx] or luminance [cd/m²]. */
export function ofLuminance(
  parameters: AtmosphereParameters,
  values: readonly number[],
  luminance: number
): number[] {
  const scale = luminance / (luminanceOf(parameters, values) || 1)
  return values.map(value => value * scale)
}

/**
 * Irradiance by light of a star's colour, over `solarIrradiance`, at the four wavelengths.
 *
 * @param colorIndex - B − V [mag].
 * @param illuminance - [lx]
 */
export function starIrradiance(
  parameters: AtmosphereParameters,
  colorIndex: number,
  illuminance: number
): number[] {
  const temperature = colorTemperature(colorIndex)
  const values = parameters.wavelengths.map((nm, i) => {
    const planck = (550 / nm) ** 5 / Math.expm1(SECOND_RADIATION / (nm * temperature))
    return planck / (parameters.solarIrradiance[i] || Infinity)
  })
  return ofLuminance(parameters, values, illuminance)
}
