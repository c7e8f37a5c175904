import type { AtmosphereParameters, AtmosphereParametersInit, Spectrum } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'

/** Wavelengths of the sliders, those of the parameters [nm]. */
export const WAVELENGTHS = [440, 520, 560, 630] as const

/** Names of spectra that have a slider for each wavelength. */
export type SpectrumName =
  | 'molecules'
  | 'aerosols'
  | 'aerosolAlbedo'
  | 'asymmetry'
  | 'absorber'
  | 'ground'

export type SpectrumArgs = Record<`${SpectrumName}${(typeof WAVELENGTHS)[number]}`, number>

/** Air of the sandbox, as its sliders have it. */
export interface AirArgs extends SpectrumArgs {
  /** Factor on the scattering by molecules. */
  moleculesAmount: number
  /** [km] */
  moleculesHeight: number
  /** Layers of the U.S. Standard Atmosphere 1976 above the lowest. */
  standardLayers: boolean
  /** Factor on the extinction by aerosols. */
  aerosolsAmount: number
  /** [km] */
  aerosolsHeight: number
  /** Factor on the absorber, ozone on the Earth. */
  absorberAmount: number
  /** [km] */
  absorberAltitude: number
  /** [km] */
  absorberHalfWidth: number
  /** [km] */
  radius: number
  /** Ground to the top of the air [km]. */
  thickness: number
  /** Divides all lengths and multiplies all scattering: a smaller planet with the same sky. */
  miniature: number
  /** [astronomical units] */
  sunDistance: number
  /** Surface temperature of the star [K]. */
  sunTemperature: number
  /** Angular radius [°]. */
  sunRadius: number
  /** Factor on the sun's limb darkening, in [0, 1]. */
  limbDarkening: number
}

/** Temperature of the sun's surface [K]. */
export const SUN_TEMPERATURE = 5772

/** Scattering per megametre, the unit of the sliders, to 1/m. */
const PER_MEGAMETRE = 1e-6
const KILOMETRE = 1000
const DEGREE = Math.PI / 180

const spectrum = (value: (i: number) => number): Spectrum => [
  value(0),
  value(1),
  value(2),
  value(3)
]

const sliders = (args: AirArgs, name: SpectrumName, factor = 1): Spectrum =>
  spectrum(i => args[`${name}${WAVELENGTHS[i]}`] * factor)

/** Planck's law: radiance at a wavelength over that at 560 nm, of a black body. */
function blackBody(nanometres: number, kelvin: number): number {
  const radiance = (nm: number) => nm ** -5 / Math.expm1(1.438_777e7 / (nm * kelvin))
  return radiance(nanometres) / radiance(560)
}

/** Layers above the lowest, of the U.S. Standard Atmosphere 1976: base altitude, scale height [m]. */
const STANDARD_LAYERS = [
  [9800, 6420],
  [42_500, 7980],
  [71_200, 6110]
] as const

/**
 * Parameters that the sliders stand for. What they leave out of its range is moved to the nearest that is allowed.
 *
 * @param earth - Default parameters, with the sun of the Earth.
 * @returns Parameters, and in words what was moved.
 */
export function parametersOf(
  args: AirArgs,
  earth: AtmosphereParameters
): { init: AtmosphereParametersInit; notes: string[] } {
  const notes: string[] = []
  const clamp = (name: string, value: number, least: number, most: number): number => {
    const clamped = Math.min(Math.max(value, least), most)
    if (clamped !== value) notes.push(`${name}: ${legible(value)} is shown as ${legible(clamped)}`)
    return clamped
  }
  const small = args.miniature
  const length = (name: string, kilometres: number) =>
    clamp(`${name} [m]`, (kilometres * KILOMETRE) / small, 1, 1e6)
  const scattering = (name: SpectrumName, amount: number) =>
    sliders(args, name, amount * PER_MEGAMETRE * small).map(value =>
      clamp(`${name} [1/m]`, value, 0, 1)
    ) as unknown as Spectrum

  const bottomRadius = clamp('Radius [m]', (args.radius * KILOMETRE) / small, 5000, 1e8)
  const thickness = (args.thickness * KILOMETRE) / small
  const least = 1.1e-5 * bottomRadius
  const topRadius = bottomRadius + clamp('Thickness [m]', thickness, least, 0.499 * bottomRadius)
  const mieExtinction = scattering('aerosols', args.aerosolsAmount)
  const albedo = sliders(args, 'aerosolAlbedo')
  const init = {
    bottomRadius,
    topRadius,
    ellipsoid: new Ellipsoid(bottomRadius),
    rayleighScattering: scattering('molecules', args.moleculesAmount),
    rayleighScaleHeight: length('Scale height of molecules', args.moleculesHeight),
    rayleighLayers: args.standardLayers
      ? STANDARD_LAYERS.map(([base, height]) => [base / small, height / small] as const)
      : [],
    mieExtinction,
    mieScattering: spectrum(i => mieExtinction[i] * albedo[i]),
    mieScaleHeight: length('Scale height of aerosols', args.aerosolsHeight),
    mieAsymmetry: sliders(args, 'asymmetry'),
    absorptionExtinction: scattering('absorber', args.absorberAmount),
    absorptionAltitude: (args.absorberAltitude * KILOMETRE) / small,
    absorptionHalfWidth: length('Half width of the absorber', args.absorberHalfWidth),
    groundAlbedo: sliders(args, 'ground'),
    solarIrradiance: spectrum(i => {
      const color = (kelvin: number) => blackBody(WAVELENGTHS[i], kelvin)
      const star = color(args.sunTemperature) / color(SUN_TEMPERATURE)
      return (earth.solarIrradiance[i] * star) / args.sunDistance ** 2
    }),
    sunAngularRadius: args.sunRadius * DEGREE,
    limbDarkening: spectrum(i => earth.limbDarkening[i] * args.limbDarkening)
  }
  return { init, notes: [...new Set(notes)] }
}

/** Sliders that stand for parameters: the other way of {@link parametersOf}. */
export function airArgsOf(parameters: AtmosphereParameters, earth: AtmosphereParameters): AirArgs {
  const spread = (name: SpectrumName, values: readonly number[]) =>
    Object.fromEntries(WAVELENGTHS.map((nm, i) => [`${name}${nm}`, rounded(values[i])]))
  const perMegametre = (values: Spectrum) => values.map(value => value / PER_MEGAMETRE)
  const { bottomRadius, topRadius, mieExtinction, mieScattering, mieAsymmetry } = parameters
  const all = {
    ...spread('molecules', perMegametre(parameters.rayleighScattering)),
    ...spread('aerosols', perMegametre(mieExtinction)),
    ...spread(
      'aerosolAlbedo',
      mieScattering.map((value, i) => (mieExtinction[i] > 0 ? value / mieExtinction[i] : 1))
    ),
    ...spread(
      'asymmetry',
      WAVELENGTHS.map((_, i) => (typeof mieAsymmetry === 'number' ? mieAsymmetry : mieAsymmetry[i]))
    ),
    ...spread('absorber', perMegametre(parameters.absorptionExtinction)),
    ...spread('ground', parameters.groundAlbedo)
  } as SpectrumArgs
  return {
    ...all,
    moleculesAmount: 1,
    moleculesHeight: parameters.rayleighScaleHeight / KILOMETRE,
    standardLayers: parameters.rayleighLayers.length > 0,
    aerosolsAmount: 1,
    aerosolsHeight: parameters.mieScaleHeight / KILOMETRE,
    absorberAmount: 1,
    absorberAltitude: parameters.absorptionAltitude / KILOMETRE,
    absorberHalfWidth: parameters.absorptionHalfWidth / KILOMETRE,
    radius: rounded(bottomRadius / KILOMETRE),
    thickness: rounded((topRadius - bottomRadius) / KILOMETRE),
    miniature: 1,
    sunDistance: rounded(Math.sqrt(earth.solarIrradiance[1] / parameters.solarIrradiance[1])),
    sunTemperature: SUN_TEMPERATURE,
    sunRadius: rounded(parameters.sunAngularRadius / DEGREE),
    limbDarkening: 1
  }
}

/** Four significant digits. */
const rounded = (value: number): number => Number(value.toPrecision(4))
const legible = (value: number): string => String(rounded(value))
