import { readFileSync } from 'node:fs'
import { AtmosphereParameters, type Spectrum } from '../src/parameters/AtmosphereParameters'
import type { Triple } from '../src/air/cpu/color'
import {
  ANGSTROM_EXPONENT,
  rayleighCrossSection,
  standardEarthParameters
} from '../src/parameters/standardEarth'

const spectra = JSON.parse(
  readFileSync(new URL('../../../e2e/reference/spectra.json', import.meta.url), 'utf8')
) as {
  wavelengths_nm: number[]
  solar_irradiance_W_m2_nm: number[]
  ozone_cross_section_m2: number[]
  cie1931_2deg: { wavelengths_nm: number[]; x: number[]; y: number[]; z: number[] }
}

/** Spacing of the wavelengths that spectra are sampled at [nm]. */
const STEP = 10

/** 35 wavelengths, and one more to make them fours [nm]. */
export const wavelengths: number[] = Array.from({ length: 36 }, (_, i) => 380 + STEP * i)

const lookUp = (values: number[], grid: number[], nm: number): number => {
  const index = grid.indexOf(nm)
  if (index < 0) throw new Error(`spectra.json has nothing for ${nm} nm`)
  return values[index]
}

const solarIrradiance = (nm: number): number =>
  lookUp(spectra.solar_irradiance_W_m2_nm, spectra.wavelengths_nm, nm)

/** The sun above the air, at {@link wavelengths} [W/m²/nm]. */
export const sunlight: number[] = wavelengths.map(solarIrradiance)

const weights: Triple[] = wavelengths.map((nm, i) => {
  if (i === 35) return [0, 0, 0]
  const { wavelengths_nm: grid, x, y, z } = spectra.cie1931_2deg
  return [x, y, z].map(values => STEP * lookUp(values, grid, nm)) as Triple
})

/** CIE 1931 XYZ, in 683⁻¹ cd/m² (or lx), of a spectrum at {@link wavelengths} per nm. */
export function spectrumToXYZ(values: readonly number[]): Triple {
  return [0, 1, 2].map(k =>
    values.reduce((sum, value, i) => sum + value * weights[i][k], 0)
  ) as Triple
}

const ozone = (nm: number): number =>
  lookUp(spectra.ozone_cross_section_m2, spectra.wavelengths_nm, nm)

const spectrumAt = (nm: readonly number[], f: (nm: number) => number): Spectrum =>
  nm.map(f) as unknown as Spectrum

/** The Earth's default air at four of {@link wavelengths}. */
export function earthAt(nm: readonly number[], groundAlbedo = 0.1): AtmosphereParameters {
  const earth = new AtmosphereParameters()
  const spectrum = (f: (nm: number) => number): Spectrum => spectrumAt(nm, f)
  return new AtmosphereParameters({
    wavelengths: spectrum(x => x),
    solarIrradiance: spectrum(solarIrradiance),
    rayleighScattering: spectrum(
      x => earth.rayleighScattering[0] * (earth.wavelengths[0] / x) ** 4
    ),
    absorptionExtinction: spectrum(
      x => (earth.absorptionExtinction[0] * ozone(x)) / ozone(earth.wavelengths[0])
    ),
    groundAlbedo: spectrum(() => groundAlbedo)
  })
}

/** Air of `standardEarthParameters` at four of {@link wavelengths}. */
export function standardAt(nm: readonly number[]): AtmosphereParameters {
  const air = standardEarthParameters()
  const [first] = air.wavelengths
  const aerosols = (x: number): number => (x / first) ** -ANGSTROM_EXPONENT
  return air.set({
    wavelengths: spectrumAt(nm, x => x),
    solarIrradiance: spectrumAt(nm, solarIrradiance),
    rayleighScattering: spectrumAt(
      nm,
      x => (air.rayleighScattering[0] * rayleighCrossSection(x)) / rayleighCrossSection(first)
    ),
    mieScattering: spectrumAt(nm, x => air.mieScattering[0] * aerosols(x)),
    mieExtinction: spectrumAt(nm, x => air.mieExtinction[0] * aerosols(x)),
    absorptionExtinction: spectrumAt(
      nm,
      x => (air.absorptionExtinction[0] * ozone(x)) / ozone(first)
    )
  })
}
