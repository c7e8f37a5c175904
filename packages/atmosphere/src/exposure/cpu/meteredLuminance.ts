import type { MeteredLuminance } from './exposedScale'

/** Form of the meter: what it samples of a picture, and the luminances that it tells apart. */
export const meterForm = {
  /** Cells of a picture that are metered, across and down; each has four samples. */
  cells: [64, 36],
  /** Pixels of a sample, across and down. */
  taps: 4,
  /** log2 of the luminance that stands for black: the least number of a half float. */
  darkest: -24,
  /** log2 of the most that is metered: the greatest number of a half float, rounded up. */
  brightest: 16
} as const

/** Bins of the histogram per stop. */
const BINS_PER_STOP = 8

/** Part of the picture that is no darker than what is told as `light`. */
const LIGHT_PART = 0.1

/** Stops under the upper percentile at which what is dark begins to count less, and counts no more. */
const FADE = [8, 12] as const

/** Standard deviation of the weight around the middle, in widths and heights of the picture. */
const CENTER_WIDTH = 0.25

/**
 * Weights of cells, row by row: even, and more in the middle by a Gaussian.
 *
 * @param centerWeight - 0 is even, 1 the Gaussian alone.
 */
export function cellWeights(centerWeight: number): Float64Array {
  const [width, height] = meterForm.cells
  return Float64Array.from({ length: width * height }, (_, i) => {
    const x = ((i % width) + 0.5) / width - 0.5
    const y = (Math.floor(i / width) + 0.5) / height - 0.5
    const middle = Math.exp(-(x * x + y * y) / (2 * CENTER_WIDTH ** 2))
    return 1 - centerWeight * (1 - middle)
  })
}

/** Distribution of log2 luminance by weight. */
interface Histogram {
  /** Weight of each bin. */
  weights: Float64Array
  /** Weight times log2 luminance of each bin, so that means are exact. */
  sums: Float64Array
  /** Weight of all bins. */
  total: number
  /** Weight of the picture, black and all. */
  whole: number
}

function histogramOf(logs: ArrayLike<number>, weights: ArrayLike<number>): Histogram {
  const bins = (meterForm.brightest - meterForm.darkest) * BINS_PER_STOP + 1
  const [counts, products] = [new Float64Array(bins), new Float64Array(bins)]
  const histogram = { weights: counts, sums: products, total: 0, whole: 0 }
  for (let i = 0; i < logs.length; i++) {
    const log = Math.min(logs[i], meterForm.brightest)
    const weight = weights[i >> 2]
    histogram.whole += weight
    if (!(log > meterForm.darkest)) continue
    const bin = Math.floor((log - meterForm.darkest) * BINS_PER_STOP)
    histogram.weights[bin] += weight
    histogram.sums[bin] += weight * log
    histogram.total += weight
  }
  return histogram
}

/** Bin and log2 luminance in which a part of the weight is reached. */
function percentile({ weights, sums, total }: Histogram, part: number): number {
  let sum = 0
  let last = meterForm.darkest
  for (let bin = 0; bin < weights.length; bin++) {
    if (weights[bin] === 0) continue
    sum += weights[bin]
    last = sums[bin] / weights[bin]
    if (sum >= part * total) break
  }
  return last
}

/**
 * log2 of the luminance that a picture is exposed for: the mean between two percentiles of the histogram, without
 * what is too dark to be seen beside the bright.
 *
 * @param logs - Four samples a cell, row by row: log2 of luminance in any unit. {@link meterForm.darkest} and less, or not a
 *   number, is black and does not count.
 * @param weights - Weight of each cell.
 * @returns Mean, what a tenth exceeds of what is not black, and the upper percentile, in the samples' unit, and the part that is
 *   seen; {@link meterForm.darkest} and 1 if all is black.
 */
export function meteredLogLuminance(
  logs: ArrayLike<number>,
  weights: ArrayLike<number>,
  percentiles: readonly [number, number]
): MeteredLuminance {
  const histogram = histogramOf(logs, weights)
  const { darkest } = meterForm
  if (histogram.total === 0) return { mean: darkest, light: darkest, bright: darkest, seen: 1 }
  const [low, high] = percentiles.map(part => part * histogram.total)
  const bright = percentile(histogram, percentiles[1])
  let [below, sum, total, seen] = [0, 0, 0, 0]
  histogram.weights.forEach((weight, bin) => {
    if (weight === 0) return
    const inside = Math.max(Math.min(below + weight, high) - Math.max(below, low), 0)
    below += weight
    const log = histogram.sums[bin] / weight
    const visibility = Math.min(Math.max((FADE[1] - (bright - log)) / (FADE[1] - FADE[0]), 0), 1)
    sum += inside * visibility * log
    total += inside * visibility
    seen += weight * visibility
  })
  const light = percentile(histogram, 1 - LIGHT_PART)
  const mean = total > 0 ? sum / total : bright
  return { mean, light, bright, seen: seen / histogram.whole }
}
