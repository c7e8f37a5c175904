/** Transmittance: (cosine of the zenith angle, altitude). */
export const TRANSMITTANCE_SIZE = [256, 64] as const

/** Diffuse light: (cosine of the light's zenith angle, altitude), a tile per quantity in {@link DIFFUSE_TILES}. */
export const DIFFUSE_SIZE = [96, 16] as const

/**
 * Tiles of the diffuse-light table: six moments, then the irradiance on a plane that faces up and on one
 * that faces down.
 */
export const DIFFUSE_TILES = 8

/** Columns × rows of those tiles in their texture. */
export const DIFFUSE_LAYOUT = [2, 4] as const

/** Sky volume: azimuth × elevation × distance. */
export const VOLUME_SIZE = [32, 96, 23] as const

/**
 * Length of a ray for which the volume keeps its light, in the mean up to each distance [m]. Just below the horizon
 * lengths change manyfold from one elevation to the next, where light per length hardly does. Greater: thick haze
 * overflows half floats. Smaller: they round deep twilight off.
 */
export const LIGHT_LENGTH = 16_000

/** Places that volumes are kept for at a time, for each source of light: a camera and its mirror image, say. */
export const VOLUME_SLOTS = 2

/**
 * Layout of the sky volume's distances in its atlas: columns × rows of tiles. One tile follows the
 * last distance: all the air along a ray and the ground behind it.
 */
export const VOLUME_TILES = [6, 4] as const

/**
 * Mean extinction along rays: elevation × distance, and a row of the whole ray's transmittance. Elevations are cheap here, and many are needed.
 */
export const DEPTH_SIZE = [192, 32] as const

/** Factor by which tables of radiance are scaled, to stay clear of subnormal half floats at night. */
export const RADIANCE_SCALE = 4096
