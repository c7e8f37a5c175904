/** Rules by which the ground consists of what it does, for the shader and the CPU. Heights in m, steps as [from, to]. */

/**
 * Height of the snow line, by the sine s of the latitude: equator − square · s² − fourth · s⁴. Snow lies above 5,200 m at the equator, 3,100 m in the
 * Alps, 1,700 m at 60°, and at sea level near the poles.
 */
export const SNOW_LINE = {
  equator: 5200,
  square: 2000,
  fourth: 3600,
  /** Height by which it lies higher where it is dry, per climate, and on slopes to the equator, per slope. */
  dry: 500,
  sunny: 350
} as const

/** Snow by the height over its line, patches and slope. */
export const SNOW = { over: [-150, 250], patch: 420, steepness: [0.26, 0.42] } as const

/** Height of the snow line over the tree line, and share of patches in that. */
export const TREES = { below: 1100, patch: 350, end: [-150, 50], overSea: [15, 60] } as const

/** Dryness: that of the belts about the tropics, by the sine of the latitude, that of all land, and its share of the climate. */
export const DRYNESS = {
  begins: [0.12, 0.4],
  ends: [0.42, 0.62],
  belts: 1.1,
  least: -0.35,
  climate: 1.4
} as const

/**
 * Moisture of woods: share of the climate in it, less: land from orbit is of one colour (*Terrain*); part of the patches that is open where it is
 * neither wet nor dry; moisture that land just above the sea lacks, and heights over it between which it does: open plains below woods.
 */
export const WOODS = { climate: 1.4, open: 0.15, lowland: { dry: 0.4, over: [60, 420] } } as const

/** Moisture from which on all is woods, and below which nothing is. */
export const MOIST = 0.2

/** Slope, as 1 less its cosine, with patches: rock where it is steep. */
export const ROCK = { steepness: [0.13, 0.24], patch: 0.05 } as const

/** Sand by the height over the sea, and share of patches in it. */
export const SHORE = { over: [2, 9], patch: 4 } as const

/** Scree by the height over the tree line. */
export const SCREE = [-50, 450] as const
