import { checkOptions, checkPositive, Ellipsoid } from '@welkin/geo'
import { checkRange } from '../check'
import { AtmosphereParameters, type Spectrum } from './AtmosphereParameters'

const map = (values: Spectrum, f: (value: number, i: number) => number): Spectrum =>
  values.map(f) as unknown as Spectrum

/**
 * Wavelengths and sunlight at a distance from the sun.
 *
 * @param distance - Planet to sun [astronomical units].
 */
function sunAt(distance: number) {
  const { wavelengths, solarIrradiance, sunAngularRadius, limbDarkening } =
    new AtmosphereParameters()
  return {
    wavelengths,
    solarIrradiance: map(solarIrradiance, value => value / distance ** 2),
    sunAngularRadius: sunAngularRadius / distance,
    limbDarkening
  }
}

/**
 * Rayleigh scattering of a gas [1/m].
 *
 * @param density - Number density of molecules at the ground [1/m³].
 * @param crossSection - Cross-section of a molecule at 532.2 nm [m²], taken as λ⁻⁴ at other wavelengths.
 * @see Sneep & Ubachs 2005, "Direct measurement of the Rayleigh scattering cross section in various
 * gases", JQSRT 92: CO₂ 12.4e-31, N₂ 5.10e-31 m²
 */
const rayleigh = (wavelengths: Spectrum, density: number, crossSection: number): Spectrum =>
  map(wavelengths, nm => density * crossSection * (532.2 / nm) ** 4)

const CO2_CROSS_SECTION = 12.4e-31
const N2_CROSS_SECTION = 5.1e-31

const NONE: Spectrum = [0, 0, 0, 0]

/**
 * Mars's dust at the four wavelengths: extinction relative to 630 nm, single-scattering albedo and
 * asymmetry, by Mie theory for a gamma distribution of r_eff 1.6 µm, v_eff 0.2 and refractive index
 * 1.5 − ik, k = 0.0110, 0.0067, 0.0051, 0.0035 (`scripts/mie.ts`; its asymmetries are 0.840, 0.797,
 * 0.781, 0.754). The asymmetries are 0.08 less than those of spheres: irregular grains scatter more to
 * the side.
 *
 * @see Tomasko et al. 1999, "Properties of dust in the Martian atmosphere from the Imager on Mars
 * Pathfinder", JGR 104; Pollack et al. 1995, "Viking Lander image analysis of Martian atmospheric
 * dust", JGR 100
 */
const MARS_DUST = {
  extinction: [0.959, 0.976, 0.982, 1] as Spectrum,
  albedo: [0.718, 0.814, 0.854, 0.902] as Spectrum,
  asymmetry: [0.76, 0.717, 0.701, 0.674] as Spectrum
}

/**
 * Mars: thin carbon dioxide full of dust, which absorbs blue light and scatters it closer to the sun than
 * red. The sky is butterscotch by day and blue around the setting sun.
 *
 * Gas: 610 Pa at 210 K (2.1e23 molecules/m³), scale height 11.1 km, in which the dust is mixed evenly
 * (Conrath 1975 near the ground). Ground: mean of bright and dark regions after Bell et al. 1997
 * (JGR 102, "Mars surface mineralogy from HST").
 *
 * @param options - `dust`: optical depth of dust to the zenith at 630 nm, in [0, 10]: 0.3 to 0.6 on clear
 *   days (default 0.5), several in a dust storm.
 * @throws If it is out of its range.
 */
export function marsParameters(options: { dust?: number } = {}): AtmosphereParameters {
  const { dust = 0.5 } = checkOptions('marsParameters', options, 'dust')
  checkRange('marsParameters', 'dust', dust, 0, 10)
  const sun = sunAt(1.5237)
  const scaleHeight = 11_100
  const extinction = map(MARS_DUST.extinction, value => (value * dust) / scaleHeight)
  return new AtmosphereParameters({
    ...sun,
    bottomRadius: 3_396_190,
    // IAU 2015, Archinal et al. 2018.
    ellipsoid: new Ellipsoid(3_396_190, 3_396_190, 3_376_200),
    topRadius: 3_396_190 + 110_000,
    rayleighScattering: rayleigh(sun.wavelengths, 2.1e23, CO2_CROSS_SECTION),
    rayleighScaleHeight: scaleHeight,
    mieScattering: map(extinction, (value, i) => value * MARS_DUST.albedo[i]),
    mieExtinction: extinction,
    mieScaleHeight: scaleHeight,
    mieAsymmetry: MARS_DUST.asymmetry,
    absorptionExtinction: NONE,
    groundAlbedo: [0.07, 0.12, 0.16, 0.25]
  })
}

/**
 * Venus above its clouds: the ground is the cloud deck at 65 km, the planet's visible surface; the air
 * beneath is not modelled.
 *
 * Gas at 65 km: 97.7 hPa, 243 K, scale height 5.2 km (VIRA, Seiff et al. 1985). Haze of sulphuric acid
 * droplets: scale height 4 km and optical depth 3 above the deck (Ignatiev et al. 2009, JGR 114:
 * optical depth 1 at 70 km or so), asymmetry by Mie theory for r_eff 1.05 µm (Hansen & Hovenier 1974),
 * no absorption. The deck's albedo, with the unknown absorber of blue light in it, gives the planet
 * its spherical albedo of about 0.76 (Moroz 1981).
 */
export function venusParameters(): AtmosphereParameters {
  const sun = sunAt(0.7233)
  const haze: Spectrum = [0.00075, 0.00075, 0.00075, 0.00075]
  return new AtmosphereParameters({
    ...sun,
    bottomRadius: 6_116_800,
    topRadius: 6_116_800 + 50_000,
    rayleighScattering: rayleigh(sun.wavelengths, 2.91e24, CO2_CROSS_SECTION),
    rayleighScaleHeight: 5200,
    mieScattering: haze,
    mieExtinction: haze,
    mieScaleHeight: 4000,
    mieAsymmetry: [0.76, 0.735, 0.715, 0.695],
    absorptionExtinction: NONE,
    groundAlbedo: [0.66, 0.8, 0.84, 0.87]
  })
}

/**
 * Titan: thick orange haze over nitrogen.
 *
 * Haze: optical depth to the zenith from the sum of the three layers of Tomasko et al. 2008 ("A model
 * of Titan's aerosols based on measurements made inside the atmosphere", PSS 56), in one layer of scale
 * height 80 km; single-scattering albedo and asymmetry near theirs. Gas: 1467 hPa at 93.7 K (Fulchignoni
 * et al. 2005), scale height 20 km. Light is scattered more than the five times that the tables solve
 * for; they extrapolate the rest.
 */
export function titanParameters(): AtmosphereParameters {
  const sun = sunAt(9.58)
  const scaleHeight = 80_000
  const albedo = [0.7, 0.84, 0.88, 0.93]
  const extinction = map([12.17, 8.96, 7.84, 6.38], depth => depth / scaleHeight)
  return new AtmosphereParameters({
    ...sun,
    bottomRadius: 2_574_730,
    topRadius: 2_574_730 + 700_000,
    rayleighScattering: rayleigh(sun.wavelengths, 1.134e26, N2_CROSS_SECTION),
    rayleighScaleHeight: 20_000,
    mieScattering: map(extinction, (value, i) => value * albedo[i]),
    mieExtinction: extinction,
    mieScaleHeight: scaleHeight,
    mieAsymmetry: [0.72, 0.7, 0.69, 0.67],
    absorptionExtinction: NONE,
    groundAlbedo: [0.08, 0.12, 0.15, 0.18]
  })
}

/**
 * Body without air: a black sky and unfiltered sunlight. By default the Moon, with the normal albedo of
 * Velikodsky et al. 2011 (Icarus 214).
 *
 * @param options - `radius` [m]; `groundAlbedo`; `distance` to the sun [astronomical units].
 * @throws If a number is out of its range.
 */
export function airlessParameters(
  options: { radius?: number; groundAlbedo?: Spectrum; distance?: number } = {}
): AtmosphereParameters {
  const {
    radius = 1_737_400,
    groundAlbedo = [0.09, 0.11, 0.12, 0.135],
    distance = 1
  } = checkOptions('airlessParameters', options, 'radius', 'groundAlbedo', 'distance')
  checkPositive('airlessParameters', 'radius', radius)
  checkRange('airlessParameters', 'distance', distance, 1e-3, 1e4)
  return new AtmosphereParameters({
    ...sunAt(distance),
    bottomRadius: radius,
    ellipsoid: new Ellipsoid(radius),
    topRadius: radius * 1.001,
    rayleighScattering: NONE,
    mieScattering: NONE,
    mieExtinction: NONE,
    absorptionExtinction: NONE,
    groundAlbedo
  })
}
