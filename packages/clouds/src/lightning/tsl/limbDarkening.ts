import type { Float } from '../../tsl-types'

/**
 * Radiance of a cloud's surface that is lit from inside, over that of an even one [–]: (1 + 1.5 μ)/2, of which the mean over the light that leaves is 1.
 *
 * @param facing - μ, cosine between the surface's normal and the way to the eye.
 * @see Milne 1930, "Thermodynamics of the stars", Handbuch der Astrophysik 3, §33: limb darkening in Eddington's approximation
 */
export const limbDarkening = (facing: Float): Float => facing.clamp(0, 1).mul(0.75).add(0.5)
