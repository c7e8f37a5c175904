import { checkOptions } from '@welkin/geo'
import { checkRange } from '../check'
import { AtmosphereParameters, type Spectrum } from './AtmosphereParameters'

const map = (values: Spectrum, f: (value: number) => number): Spectrum =>
  values.map(f) as unknown as Spectrum

/** Number density of air at sea level, p/(k T): 288.15 K and 1013.25 hPa [1/m³]. */
const MOLECULES_AT_SEA_LEVEL = 2.5469e25

/**
 * Rayleigh cross-section of a molecule of air with 360 ppm CO₂ [m²].
 *
 * @param nanometres - Wavelength [nm].
 * @see Bodhaine et al. 1999, "On Rayleigh optical depth calculations", J. Atmos. Oceanic Technol. 16,
 *   eq. 29: within 0.01 % of their theory from 250 to 850 nm
 */
export function rayleighCrossSection(nanometres: number): number {
  const square = (nanometres * 1e-3) ** 2
  const above = 1.0455996 - 341.29061 / square - 0.9023085 * square
  return (1e-32 * above) / (1 + 0.0027059889 / square - 85.968563 * square)
}

/**
 * Ångström exponent: optical depth of aerosols is proportional to λ^−1.3.
 *
 * @see Preetham et al. 1999, "A practical analytic model for daylight", appendix A.1
 */
export const ANGSTROM_EXPONENT = 1.3

/**
 * Earth's air on an average clear day, for realistic brightness in daylight and twilight.
 *
 * The density of molecules is that of the U.S. Standard Atmosphere 1976, in four layers within
 * 3.5 % of its tables up to 60 km, 7 % to 90 km and 20 % at the top, 100 km; their optical depth is
 * 0.0969 at 550 nm (Bodhaine et al. 1999: 0.0971), where the default's is 0.1085. Aerosols have the
 * single-scattering albedo 0.925 and mean cosine of scattering 0.703 of average continental ones at
 * 550 nm (Hess, Koepke & Schult 1998, OPAC, table 4), and the default's scale height, 1.2 km (Elterman
 * 1968). With the default's optical depth level ground gets the light that the almanac tabulates, within
 * 25 %, wherever the sun stands from the zenith to 12° below the horizon, the night sky's light added;
 * with 0.05 it is up to 33 % brighter.
 *
 * @param options - `aerosolOpticalDepth`: optical depth of aerosols to the zenith at 550 nm, in [0, 5]; by
 *   default 0.12, the global mean (Kinne et al. 2006, Atmos. Chem. Phys. 6: models 0.11 to 0.14); 0.05 is very
 *   clear, 0.4 hazy. `ozone` in [0, 1000] [Dobson units], default 300.
 * @throws If a number is out of its range.
 */
export function standardEarthParameters(
  options: { aerosolOpticalDepth?: number; ozone?: number } = {}
): AtmosphereParameters {
  const { aerosolOpticalDepth = 0.12, ozone = 300 } = checkOptions(
    'standardEarthParameters',
    options,
    'aerosolOpticalDepth',
    'ozone'
  )
  checkRange('standardEarthParameters', 'aerosolOpticalDepth', aerosolOpticalDepth, 0, 5)
  const { bottomRadius, wavelengths, mieScaleHeight, absorptionExtinction } =
    new AtmosphereParameters({ ozone })
  const mieExtinction = map(
    wavelengths,
    nm => (aerosolOpticalDepth / mieScaleHeight) * (nm / 550) ** -ANGSTROM_EXPONENT
  )
  return new AtmosphereParameters({
    topRadius: bottomRadius + 100_000,
    rayleighScattering: map(wavelengths, nm => MOLECULES_AT_SEA_LEVEL * rayleighCrossSection(nm)),
    // Troposphere, stratosphere, stratopause and above, mesopause.
    rayleighScaleHeight: 9570,
    rayleighLayers: [
      [9800, 6420],
      [42_500, 7980],
      [71_200, 6110]
    ],
    mieScattering: map(mieExtinction, value => 0.925 * value),
    mieExtinction,
    // The Cornette–Shanks phase function's mean cosine is 3g(4 + g²)/(5(2 + g²)).
    mieAsymmetry: 0.64,
    absorptionExtinction
  })
}
