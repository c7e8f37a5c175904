import { xyzToLinearSRGB, type Triple } from '../../src/air/cpu/color'
import { spectrumToXYZ, sunlight } from '../spectra'

const white = xyzToLinearSRGB(spectrumToXYZ(sunlight))

/**
 * Colour of sunlight times a factor of each wavelength, over that of sunlight alone, in linear sRGB.
 *
 * @param factors - At the 35 `wavelengths` of spectra.ts, and one more that does not count.
 */
export function sunlitColor(factors: readonly number[]): Triple {
  const color = xyzToLinearSRGB(spectrumToXYZ(factors.map((factor, i) => factor * sunlight[i])))
  return color.map((value, i) => value / white[i]) as Triple
}
