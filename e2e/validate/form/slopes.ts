import { powerSpectrum } from '../power-spectrum'

/** Slope of log y against log x by least squares; NaN for fewer than three points. */
export function logSlope(x: readonly number[], y: readonly number[]): number {
  if (x.length < 3) return NaN
  const [a, b] = [x, y].map(values => values.map(Math.log))
  const mean = (values: readonly number[]): number => values.reduce((s, v) => s + v) / values.length
  const [ma, mb] = [mean(a), mean(b)]
  const covariance = a.reduce((s, v, i) => s + (v - ma) * (b[i] - mb), 0)
  return covariance / a.reduce((s, v) => s + (v - ma) ** 2, 0)
}

/** Values sorted into bins of equal width in log x: each bin's middle, edges and values. */
function logBins(
  points: readonly [x: number, y: number][],
  low: number,
  high: number,
  count: number
): { middle: number; width: number; values: number[] }[] {
  const edge = (i: number): number => low * (high / low) ** (i / count)
  const bins = Array.from({ length: count }, (_, i) => ({
    middle: Math.sqrt(edge(i) * edge(i + 1)),
    width: edge(i + 1) - edge(i),
    values: [] as number[]
  }))
  for (const [x, y] of points) {
    bins[Math.floor((count * Math.log(x / low)) / Math.log(high / low))]?.values.push(y)
  }
  return bins.filter(({ values }) => values.length > 0)
}

/**
 * Slope of a square picture's one-dimensional spectrum between two wavelengths.
 *
 * @param cell - Width of a pixel [m].
 * @param longest - Longest wavelength [m].
 * @param shortest - Shortest wavelength [m].
 */
export function spectrumSlope(
  picture: number[],
  size: number,
  cell: number,
  longest: number,
  shortest: number
): number {
  const signed = (k: number): number => (k > size / 2 ? k - size : k)
  const points = powerSpectrum(picture, size).flatMap((power, i): [number, number][] => {
    const wave = Math.hypot(signed(i % size), signed(Math.floor(i / size))) / (size * cell)
    return wave > 0 ? [[wave, power]] : []
  })
  const bins = logBins(points, 1 / longest, 1 / shortest, 6)
  return logSlope(
    bins.map(({ middle }) => middle),
    bins.map(({ middle, values }) => (middle * values.reduce((a, b) => a + b)) / values.length)
  )
}

/** Slope of the number density of widths over width; NaN for a dozen widths or fewer. */
export function sizeSlope(widths: readonly number[]): number {
  if (widths.length <= 12) return NaN
  const points = widths.map((width): [number, number] => [width, 1])
  const bins = logBins(points, Math.min(...widths), Math.max(...widths) * 1.001, 7)
  return logSlope(
    bins.map(({ middle }) => middle),
    bins.map(({ values, width }) => values.length / width)
  )
}
