import type { Triple } from '../../air/cpu/color'
import type { Spectrum } from '../../parameters/AtmosphereParameters'

/**
 * Factors of sunlight at the four wavelengths that give it a colour: the right inverse of `whiteBalancedColumns` of
 * Earth's parameters which leaves white as it is and is least otherwise.
 */
const SPECTRA: readonly Readonly<Triple>[] = [
  [0.2503116, -0.2025203, 0.9522087],
  [-0.263517, 0.9888558, 0.2746612],
  [0.3849695, 0.7942436, -0.1792131],
  [0.6300355, 0.0591963, 0.3107682]
]

/** Factors at the four wavelengths by which sunlight has a colour, given in linear sRGB over that of sunlight. */
export function colorSpectrum(color: Readonly<Triple>): Spectrum {
  return SPECTRA.map(row =>
    row.reduce((sum, factor, i) => sum + factor * color[i], 0)
  ) as unknown as Spectrum
}
