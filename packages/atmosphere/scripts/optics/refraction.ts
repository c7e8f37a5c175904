/** Refractive index of air: drops scatter by theirs against it. */
const AIR = 1.00028

/** Temperature of cloud and rain water [K], and its density at that [kg/m³]. */
const WATER_TEMPERATURE = 283.15
const WATER_DENSITY = 999.7

/**
 * Refractive index of liquid water against air, from 200 to 1100 nm; its absorption counts for nothing in drops of visible light.
 *
 * @param nm - Wavelength [nm].
 * @see IAPWS R9-97, "Release on the refractive index of ordinary water substance as a function of wavelength,
 *   temperature and pressure", eq. 1 and table 1
 */
export function waterIndex(
  nm: number,
  temperature = WATER_TEMPERATURE,
  density = WATER_DENSITY
): number {
  const wave = (nm / 589) ** 2
  const warmth = temperature / 273.15
  const rho = density / 1000
  const sum =
    0.244257733 +
    9.74634476e-3 * rho -
    3.73234996e-3 * warmth +
    2.68678472e-4 * wave * warmth +
    1.5892057e-3 / wave +
    2.45934259e-3 / (wave - 0.229202 ** 2) +
    0.90070492 / (wave - 5.432937 ** 2) -
    1.66626219e-2 * rho ** 2
  const refraction = rho * sum
  return Math.sqrt((1 + 2 * refraction) / (1 - refraction)) / AIR
}

/** Refractive index of ice at every 50 nm from 350 nm on. Warren & Brandt 2008, J. Geophys. Res. 113, D14220, table of the supplement. */
const ICE = [1.3249, 1.3194, 1.3157, 1.313, 1.311, 1.3094, 1.3081, 1.3069, 1.3059]

/** Refractive index of ice, from 350 to 750 nm. @param nm - Wavelength [nm]. */
export function iceIndex(nm: number): number {
  const at = (nm - 350) / 50
  const i = Math.min(Math.floor(at), ICE.length - 2)
  // Linear in 1/λ², in which dispersion is nearly straight.
  const inverse = (k: number): number => (350 + 50 * k) ** -2
  const part = (nm ** -2 - inverse(i)) / (inverse(i + 1) - inverse(i))
  return ICE[i] + part * (ICE[i + 1] - ICE[i])
}
