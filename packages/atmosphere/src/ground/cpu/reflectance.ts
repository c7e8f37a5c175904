import type { AtmosphereParameters, Spectrum } from '../../parameters/AtmosphereParameters'
import { linearSRGBColumns, whiteBalancedColumns, type Triple } from '../../air/cpu/color'

const cross = (a: Triple, b: Triple): Triple => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0]
]
const dot = (a: readonly number[], b: readonly number[]): number =>
  a.reduce((sum, value, i) => sum + value * b[i], 0)

/** Null vector of a 3×4 matrix of columns: a spectrum that adds no colour. */
function nullVector(columns: Triple[]): number[] {
  return columns.map((_, skip) => {
    const [a, b, c] = columns.filter((_other, i) => i !== skip) as [Triple, Triple, Triple]
    return (skip % 2 === 0 ? 1 : -1) * dot(a, cross(b, c))
  })
}

/** Differences between neighbouring wavelengths: the less, the smoother. */
const slopes = (spectrum: readonly number[]): number[] =>
  spectrum.slice(1).map((value, i) => value - spectrum[i])

/**
 * Columns (red, green, blue) of the matrix from linear-sRGB reflectance to that at the four wavelengths: the
 * smoothest spectrum of that colour in sunlight above the air. White is 1 at all wavelengths; saturated
 * colours may need less than 0 or more than 1 at some.
 */
export function reflectanceColumns(
  parameters: AtmosphereParameters
): [Spectrum, Spectrum, Spectrum] {
  const columns = whiteBalancedColumns(parameters)
  const free = nullVector(columns)
  // The wavelength where the null vector is largest follows from that vector alone.
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

/** Linear sRGB of sunlight above the air [lx]. */
export function sunWhite(parameters: AtmosphereParameters): Triple {
  const columns = linearSRGBColumns(parameters, 1)
  return [0, 1, 2].map(row => columns.reduce((sum, column) => sum + column[row], 0)) as Triple
}
