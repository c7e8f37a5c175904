/** Exponential distribution of sizes: N(D) = N₀ e^{−ΛD}, with D the diameter as a drop of water. */
export interface SizeDistribution {
  /** N₀ [1/(m³ mm)]. */
  readonly intercept: number
  /** Λ [1/mm]. */
  readonly slope: number
}

/**
 * Sizes of raindrops.
 *
 * @param rate - Rate of the rain, > 0 [mm/h].
 * @see Marshall & Palmer 1948, "The distribution of raindrops with size", eqs. 1–3
 */
export const raindropSizes = (rate: number): SizeDistribution => ({
  intercept: 8000,
  slope: 4.1 * rate ** -0.21
})

/**
 * Sizes of snowflakes, by the drops that they melt to.
 *
 * @param rate - Rate of the snow as water, > 0 [mm/h].
 * @see Gunn & Marshall 1958, "The distribution with size of aggregate snowflakes", J. Meteor. 15, p. 452
 */
export const snowflakeSizes = (rate: number): SizeDistribution => ({
  intercept: 3800 * rate ** -0.87,
  slope: 2.55 * rate ** -0.48
})

/**
 * Diameter below which a share of the drops or flakes between two diameters is [mm].
 *
 * @param from - Diameter [mm].
 * @param to - Diameter [mm].
 * @param share - In [0, 1] [–].
 */
export const diameterAt = (
  { slope }: SizeDistribution,
  from: number,
  to: number,
  share: number
): number => from - Math.log1p(share * Math.expm1(slope * (from - to))) / slope

/**
 * Number of drops or flakes between two diameters [1/m³]: the integral of N(D).
 *
 * @param from - Diameter [mm].
 * @param to - Diameter, or infinity [mm].
 */
export function numberBetween(
  { intercept, slope }: SizeDistribution,
  from: number,
  to: number
): number {
  return (intercept / slope) * (Math.exp(-slope * from) - Math.exp(-slope * to))
}
