/**
 * Light among the heads of thick isolated clouds, which no slab and no sphere has. Depths towards and away from the light
 * count as scale ln(1 + depth / scale): what is deep under one head is near the side of another. A face takes light by the
 * cosine of the light on it, and the lit heads around add a glow. All of it comes in as through⁴ / (through⁴ + thick⁴), with the
 * scaled depth through the cloud.
 *
 * Fitted to Monte-Carlo solutions of 2,000 places that are seen in a simulated thunderstorm, under suns over 14°: the median
 * error goes from 74 % to 41 %, the 90th percentile from 156 % to 84 %. In simulated cumulus it hardly acts.
 */
export const headsFit = {
  thick: 30,
  toLight: 9,
  behind: 2.1,
  /** Logarithm of what a face turned to the light has over one that it grazes. */
  cosine: 1.2,
  /** Added to depths whose inverses tell how a face is turned: steps see nothing finer. */
  least: 0.3,
  /** Largest cosine between light and view that counts there: lines that close to each other tell nothing. */
  parallel: 0.8,
  /** Source function of the glow, for unit irradiance above the cloud [1/sr]. */
  glow: 0.004
} as const
