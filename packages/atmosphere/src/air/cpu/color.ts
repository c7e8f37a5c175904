import type { AtmosphereParameters, Spectrum } from '../../parameters/AtmosphereParameters'

/** Linear sRGB, or CIE XYZ. */
export type Triple = [number, number, number]

/** Luminous efficacy of light at 555 nm [lm/W]. */
const MAXIMUM_EFFICACY = 683

/** CIE XYZ (D65) to linear sRGB. IEC 61966-2-1, to seven digits. */
const XYZ_TO_LINEAR_SRGB: readonly Triple[] = [
  [3.2404542, -1.5371385, -0.4985314],
  [-0.969266, 1.8760108, 0.041556],
  [0.0556434, -0.2040259, 1.0572252]
]

const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, value, i) => sum + value * b[i], 0)

/** CIE XYZ (D65 white) to linear sRGB, same unit. */
export function xyzToLinearSRGB(xyz: Readonly<Triple>): Triple {
  return XYZ_TO_LINEAR_SRGB.map(row => dot(row, xyz)) as Triple
}

/**
 * Spectral radiance [W/m²/sr/nm] or irradiance [W/m²/nm] at the four wavelengths to linear sRGB
 * luminance [cd/m²] or illuminance [lx].
 */
export function spectralToLinearSRGB(parameters: AtmosphereParameters, values: Spectrum): Triple {
  const xyz = parameters.spectralToXYZ.map(row => MAXIMUM_EFFICACY * dot(row, values))
  return xyzToLinearSRGB(xyz as Triple)
}

/**
 * Columns of the matrix that turns radiance per unit of solar irradiance [1/sr] into linear sRGB.
 *
 * @param scale - Output per luminance [1/(cd/m²)].
 */
export function linearSRGBColumns(parameters: AtmosphereParameters, scale: number): Triple[] {
  return parameters.solarIrradiance.map((irradiance, i) => {
    const unit = [0, 0, 0, 0] as [number, number, number, number]
    unit[i] = irradiance * scale
    return spectralToLinearSRGB(parameters, unit)
  })
}

/**
 * Columns of the matrix that turns spectral transmittance into the factors by which the linear-sRGB
 * components of sunlight dim: no air gives (1, 1, 1).
 */
export function whiteBalancedColumns(parameters: AtmosphereParameters): Triple[] {
  const columns = linearSRGBColumns(parameters, 1)
  const white = [0, 1, 2].map(row => columns.reduce((sum, column) => sum + column[row], 0))
  return columns.map(column => column.map((value, row) => value / (white[row] || 1)) as Triple)
}
