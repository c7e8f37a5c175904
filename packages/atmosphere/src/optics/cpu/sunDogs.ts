/** Elevations of the sun at which sun dogs are stored [°]: at 61° and above there are none. */
export const DOG_ELEVATIONS: readonly number[] = [0, 10, 20, 30, 40, 50, 60]

/** Samples of a stored sun dog. */
export const DOG_SAMPLES = 40

/** Height of sun dogs on the sky, standard deviation, as rays through plates have it that tilt by 1° [°]. */
export const DOG_SPREAD = 0.46

/** Refractive index of ice for red light. */
export const RED_ICE = 1.3075

/** Azimuth before the least one, and range of the stored azimuths, which are even in their power of ⅔ from there on [°]. */
export const DOG_START = 2
export const DOG_RANGE = 26
