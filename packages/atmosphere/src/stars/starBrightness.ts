import type { AtmosphereParameters } from '../parameters/AtmosphereParameters'
import { scaleToLuminance } from '../parameters/photometry'

/**
 * Illuminance by a star of magnitude 0 above the air [lx].
 *
 * @see Schlyter, "Radiometry and photometry in astronomy" (stjarnhimlen.se/comp/radfaq.html), §7, after Allen 1976,
 *   Astrophysical Quantities
 */
export const MAGNITUDE_ZERO_ILLUMINANCE = 2.54e-6

/** Second radiation constant, h c / k [nm K]. @see BIPM 2019, The International System of Units, 9th ed., table 1 */
const SECOND_RADIATION_CONSTANT = 1.438776877e7

/**
 * Illuminance by a star above the air.
 *
 * @param magnitude - Apparent visual magnitude m: 10^(−0.4 m) times that of magnitude 0.
 * @returns [lx]
 */
export const starIlluminance = (magnitude: number): number =>
  MAGNITUDE_ZERO_ILLUMINANCE * 10 ** (-0.4 * magnitude)

/**
 * Temperature of the black body with a star's colour.
 *
 * @param colorIndex - B − V [mag].
 * @returns [K]
 * @see Ballesteros 2012, "New insights into black bodies", eq. 14
 */
export function colorTemperature(colorIndex: number): number {
  return 4600 * (1 / (0.92 * colorIndex + 1.7) + 1 / (0.92 * colorIndex + 0.62))
}

/**
 * Irradiance by a star at the four wavelengths, over `solarIrradiance`: a black body of its colour.
 *
 * @param colorIndex - B − V [mag].
 * @param illuminance - {@link starIlluminance} [lx].
 */
export function starIrradiance(
  parameters: AtmosphereParameters,
  colorIndex: number,
  illuminance: number
): number[] {
  const temperature = colorTemperature(colorIndex)
  const values = parameters.wavelengths.map((nm, i) => {
    const planck = (550 / nm) ** 5 / Math.expm1(SECOND_RADIATION_CONSTANT / (nm * temperature))
    return planck / (parameters.solarIrradiance[i] || Infinity)
  })
  return scaleToLuminance(parameters, values, illuminance)
}
