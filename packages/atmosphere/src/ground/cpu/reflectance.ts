import type { AtmosphereParameters, Spectrum } from '../../parameters/AtmosphereParameters'
import { linearSRGBColumns, whiteBalancedColumns, type Triple } from '../../air/cpu/color'

const cross = (a: Triple, b: Triple): Triple => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0]
]
const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, value, i) => sum + value * b[i], 0)

/** The spectrum with no change in what a 3×4 matrix of columns makes of it: its null vector. */
function nullVector(columns: Triple[]): number[] {
  return columns.map((_, skip) => {
    const [a, b, c] = columns.filter((_other, i) => i !== skip) as [Triple, Triple, Triple]
    return (skip % 2 === 0 ? 1 : -1) * dot(a, cross(b, c))
  })
}

/** Differences between neighbouring wavelengths. */
const slopes = (spectrum: readonly number[]): number[] =>
  spectrum.slice(1).map((value, i) => value - spectrum[i])

/**
 * Columns (red, green, blue) of the matrix from a linear-sRGB reflectance to one at the four
 * wavelengths: the smoothest that looks so in the light of the sun above the air. White is 1 at all of
 * them; saturated colours may need less than 0 or more than 1 at some.
 */
export function reflectanceColumns(
  parameters: AtmosphereParameters
): [Spectrum, Spectrum, Spectrum] {
  const columns = whiteBalancedColumns(parameters)
  const free = nullVector(columns)
  // The wavelength that matters least is solved for by the free vector alone.
  const skip = free.reduce(
    (most, value, i) => (Math.abs(value) > Math.abs(free[most]) ? i : most),
    0
  )
  const [a, b, c] = columns.filter((_, i) => i !== skip) as [Triple, Triple, Triple]
  const determinant = dot(a, cross(b, c))
  const inverse = [cross(b, c), cross(c, a), cross(a, b)]
  return [0, 1, 2].map(channel => {
    const spectrum = inverse.map(row => row[channel] / determinant)
    spectrum.splice(skip, 0, 0)
    const steps = slopes(free)
    const part = -dot(slopes(spectrum), steps) / dot(steps, steps)
    return spectrum.map((value, i) => value + part * free[i])
  }) as unknown as [Spectrum, Spectrum, Spectrum]
}

/** Linear sRGB of unit irradiance of the sun above the air [lx]. */
export function sunWhite(parameters: AtmosphereParameters): Triple {
  const columns = linearSRGBColumns(parameters, 1)
  return [0, 1, 2].map(row => columns.reduce((sum, column) => sum + column[row], 0)) as Triple
}
