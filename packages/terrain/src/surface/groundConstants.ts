// Constants of the rules that choose the ground's materials, for the shader and the CPU. Pairs are ranges of smooth steps.

/**
 * Height of the snow line at the equator, and what it loses by the second and the fourth power of the latitude's sine [m]: 5,200 m at the equator,
 * 3,100 m in the Alps, 1,700 m at 60°, and the sea near the poles.
 */
export const SNOW_LINE = 5200
export const SNOW_BY_SQUARE = 2000
export const SNOW_BY_FOURTH = 3600

/** Rise of the snow line where it is dry, per unit of climate, and on slopes that face the equator, per unit of slope [m]. */
export const DRY_SNOW = 500
export const SUNNY_SNOW = 350

/** Heights over the snow line between which snow begins, and their shift per unit of patches [m]; slopes between which it ends [1 − cosine]. */
export const SNOW_OVER = [-150, 250] as const
export const SNOW_PATCH = 420
export const SNOW_STEEPNESS = [0.26, 0.42] as const

/**
 * Height of the snow line over the tree line, and its shift per unit of patches; heights over the tree line between which woods end, and
 * over the sea between which they begin [m].
 */
export const TREES_BELOW = 1100
export const TREES_PATCH = 350
export const TREES_END = [-150, 50] as const
export const TREES_OVER_SEA = [15, 60] as const

/** Sines of latitude between which the dry belts begin and end, their dryness, that of all land, and that per climate [–]. */
export const DRY_BEGINS = [0.12, 0.4] as const
export const DRY_ENDS = [0.42, 0.62] as const
export const DRY_BELTS = 1.1
export const LEAST_DRYNESS = -0.35
export const DRY_CLIMATE = 1.4

/** Share of the climate in where woods grow: fewer of them where it is dry [–]. Less: land from orbit is of one colour (*Terrain*). */
export const DRY_WOODS = 1.4

/** Part of the patches that is open on level ground where it is neither wet nor dry, over half of them [–]. */
export const OPEN = 0.4

/** Moisture that land just above the sea lacks [–], and heights over it between which it does [m]: open plains below woods. */
export const LOWLAND_DRYNESS = 0.4
export const LOWLAND = [60, 420] as const

/**
 * Moisture that slopes gain on floors of valleys and plains, where people and grazing keep woods away, and slopes between which they do [1 − cosine]: 3° and
 * 14°. Without: woods from 10 km and 400 km are spots that have nothing to do with the relief (*Terrain*, Orbit).
 */
export const SLOPE_WOODS = 0.5
export const SLOPES = [0.0015, 0.03] as const

/** Moisture that a meadow lacks of what a wood has at least [–]. More: woods have no edges from 1 km and 10 km (*Terrain*). */
export const MOIST = 0.1

/** Slopes between which rock begins, and their shift per unit of patches [1 − cosine]. */
export const ROCK_STEEPNESS = [0.13, 0.24] as const
export const ROCK_PATCH = 0.05

/** Heights over the sea between which sand ends, and their shift per unit of patches; heights over the tree line between which scree begins [m]. */
export const SHORE = [2, 9] as const
export const SHORE_PATCH = 4
export const SCREE = [-50, 450] as const
