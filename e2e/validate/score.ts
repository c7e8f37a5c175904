/** Bands of the sun's zenith angle [°], ends included. */
export const bands = [
  { band: '0-80', from: 0, to: 80 },
  { band: '84-90', from: 84, to: 90 },
  { band: '91-95', from: 91, to: 95 },
  { band: '97-98', from: 97, to: 98 }
] as const

export type BandName = (typeof bands)[number]['band']

/** References below this part of the sun's irradiance are left out. */
const NEGLIGIBLE = 1e-7

/** Every so many of a list, the last of each so many. */
export const everyNth = <T>(list: readonly T[], every: number): T[] =>
  list.filter((_, i) => i % every === every - 1)

/** One value, beside its reference. */
export interface Comparison {
  sunZenith: number
  /** Signed relative error. */
  error: number
  /** The reference's own relative standard error. */
  stderr: number
  /** Name of its sample, for reports of the worst. */
  label: string
}

/** Relative errors in a band of sun angles; fractions. */
export interface Band {
  band: BandName
  n: number
  median: number
  p95: number
  max: number
  /** Median of the reference's own standard error. */
  stderr: number
}

/** Quantile by linear interpolation between order statistics. */
export function quantile(values: readonly number[], part: number): number {
  const sorted = [...values].sort((a, b) => a - b)
  const position = part * (sorted.length - 1)
  const below = Math.floor(position)
  const above = Math.min(below + 1, sorted.length - 1)
  return sorted[below] + (position - below) * (sorted[above] - sorted[below])
}

/**
 * Compares the values of a record, per unit irradiance of the sun.
 *
 * @param model - Per unit of `scale`.
 * @param scale - Per channel: what the reference's values are divided by.
 * @param label - Label of the record.
 */
export function compare(
  sunZenith: number,
  model: ArrayLike<number>,
  reference: readonly number[],
  stderr: readonly number[] | null,
  scale: readonly number[],
  label: string
): Comparison[] {
  return reference.flatMap((value, i) => {
    const expected = value / scale[i]
    if (!(expected >= NEGLIGIBLE)) return []
    const error = (model[i] - expected) / expected
    if (!Number.isFinite(error)) throw new Error(`${label}: the model gave ${model[i]}`)
    const spread = stderr === null ? 0 : stderr[i] / value
    return [{ sunZenith, error, stderr: spread, label: `${label} #${i}` }]
  })
}

/** Statistics of each band that has values. */
export function bandStatistics(comparisons: readonly Comparison[]): Band[] {
  return bands.flatMap(({ band, from, to }) => {
    const within = comparisons.filter(({ sunZenith }) => sunZenith >= from && sunZenith <= to)
    if (within.length === 0) return []
    const errors = within.map(({ error }) => Math.abs(error))
    return [
      {
        band,
        n: within.length,
        median: quantile(errors, 0.5),
        p95: quantile(errors, 0.95),
        max: Math.max(...errors),
        stderr: quantile(
          within.map(({ stderr }) => stderr),
          0.5
        )
      }
    ]
  })
}
