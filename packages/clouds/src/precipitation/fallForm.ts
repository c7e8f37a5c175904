/** Constants of precipitation: tsl/fall.ts. */
export const fallForm = {
  /**
   * Speeds at which drops of 2 mm (Gunn & Kinzer 1949, table 2), flakes (Locatelli & Hobbs 1974) and stones of 10 mm (Matson & Huggins
   * 1980) fall [m/s]. Slower: shafts lean more (*Rain and snow*).
   */
  rainSpeed: 6.5,
  snowSpeed: 1.2,
  hailSpeed: 11.5,
  /** Wind at the ground over that at the base, between which it grows evenly [–]. Greater: upright shafts (*Rain and snow*). */
  groundWind: 0.4,
  /** Exponent of the rate in the column's rank: greater, and more falls in cores, with softer edges (*Rain and snow*). */
  core: 2,
  /** Share of the layer's thickness over which rates set in above the base. 0: a gap below clouds (*Rain and snow*). */
  onset: 0.06,
  /** Depth below the freezing level in which snow melts [m]. */
  melting: 300,
  /**
   * Exponent of the rate in what evaporates: with Kessler's (1969) evaporation, ∝ (water per volume)^0.65, and water ∝ R^0.89,
   * R^0.42 falls evenly with the depth.
   */
  evaporation: 0.42,
  /** Ranks between which hail sets in where a layer has any [–]. */
  hailFrom: [0.5, 0.9],
  /**
   * Streaks: changes of the rate's logarithm by coarse and fine billows above, per deviation of their noise [–]. 0: smooth curtains;
   * greater: combs (*Rain and snow*).
   */
  coarseStreaks: 0.6,
  fineStreaks: 0.55,
  /** Height in the layer of the billows that make them, in [0, 1]: about where cloudlets are widest (*Virga*). */
  streakHeight: 0.3,
  /** Blur of streaks over the distance by which they lag, and over the depth of fall [–]: drops differ in speed. 0: lines to the ground. */
  lagBlur: 0.03,
  /**
   * Spread of the distances by which drops of one column lag, over their mean, to either side: they fall at 5 to 8 m/s (Gunn & Kinzer 1949), flakes at 0.9
   * to 1.5 m/s (Locatelli & Hobbs 1974). 0: veils with edges like cut paper far away (*Snow shower*).
   */
  lagSpread: 0.25,
  fallBlur: 0.01
} as const

/** Constants of the columns from which something falls: tsl/fallColumn.ts. */
export const columnForm = {
  /**
   * Part of the cube in the logit of the weather's distribution [–]: tails shorter than a normal distribution's. As counted over the
   * planet; 0: less falls than asked for, the smaller the share (*Snow shower*).
   */
  tail: 0.017,
  /** Exponent of the share of a storm that is nearer to its tower [–]: as counted, places near by are more than `stormPlaces` has. */
  near: 0.94,
  /** Radius of storms over the layer's thickness from which on all of the share falls [–]. 0: rain under small heaps (*Shower*). */
  grown: 0.15
} as const

/** Width of coarse streaks over the period of a layer's shape [–]. */
export const STREAK_WIDTH = 0.25

/** Share of extinguished light that is diffracted, by a tenth of a degree: it counts as not scattered (Bohren & Huffman 1983, §4.4.3). */
export const DIFFRACTED = 0.5

/**
 * Extinction of visible light by what falls: a R^b per km for a rate R of water [mm/h].
 *
 * Rain: Atlas 1953, "Optical extinction by rainfall", J. Meteor. 10, 486. Snow: that of wet flakes at 550 nm, ITU-R P.1817-1 (2012),
 * table 2: 3.84 dB/km. Hail: stones of 10 mm, 1.5 Q/(ρ D v) with Q = 2, ρ = 900 kg/m³ and v = 11.5 m/s (Matson & Huggins 1980).
 */
export const extinctionForm = {
  rain: [0.33, 0.64],
  snow: [0.885, 0.72],
  hail: 0.0081
} as const

/** Rate of the strongest streaks over that of their column [–]. */
export const STRONGEST = 6

/**
 * Rise of the median that makes up for what is cut off above `STRONGEST`: in its logarithm, a factor of the square of what the deviation of
 * logarithms has over `from` [–]. Fitted: means are 1 to 0.9 % up to a deviation of 2.5.
 */
export const streakBound = { from: 0.75, factor: 0.435 } as const

/**
 * Altitude below which nothing falls from a layer, since even the strongest streaks have evaporated [m]; −∞ where nothing evaporates.
 *
 * @param baseAltitude - Base of the layer [m].
 * @param virgaDepth - Depth in which rain of the mean rate evaporates; 0 for none [m].
 */
export function fallFloor(baseAltitude: number, virgaDepth: number): number {
  if (virgaDepth === 0) return -Infinity
  return baseAltitude - virgaDepth * ((fallForm.core + 1) * STRONGEST) ** fallForm.evaporation
}
