import type { Triple } from '../../air/cpu/color'
import type { Spectrum } from '../../parameters/AtmosphereParameters'

/**
 * Factors of sunlight at the four wavelengths that give it a colour: the right inverse of `whiteBalancedColumns` of
 * Earth's parameters which leaves white as it is and is least otherwise.
 */
const SPECTRA: readonly Readonly<Triple>[] = [
  [0.2503116, -0.20252026, 0.95220866],
  [-0.26351697, 0.98885582, 0.27466115],
  [0.38496951, 0.7942436, -0.17921311],
  [0.63003552, 0.05919628, 0.3107682]
]

/** Factors at the four wavelengths by which sunlight has a colour, given in linear sRGB over that of sunlight. */
export function colorSpectrum(color: Readonly<Triple>): Spectrum {
  return SPECTRA.map(row =>
    row.reduce((sum, factor, i) => sum + factor * color[i], 0)
  ) as unknown as Spectrum
}
