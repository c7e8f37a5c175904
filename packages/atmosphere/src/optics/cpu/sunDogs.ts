/** Elevations of the sun at which sun dogs are stored [°]: at 61° and above there are none. */
export const DOG_ELEVATIONS: readonly number[] = [0, 10, 20, 30, 40, 50, 60]

/** Samples of a stored sun dog. */
export const DOG_SAMPLES = 40

/** Tilt of plates that float level: standard deviation along either axis [°]. */
export const PLATE_TILT = 1

/** Height of sun dogs on the sky, standard deviation, as rays through such plates have it [°]. */
export const DOG_SPREAD = 0.46

/** Refractive index of ice for red light. */
export const RED_ICE = 1.3075

/** Azimuth before the least one, and range of the stored azimuths [°]. */
export const DOG_START = 2
export const DOG_RANGE = 26

/** Azimuths of the samples, from the least one: even in their root from `DOG_START` on. */
export const dogAzimuth = {
  /** @param part - In [0, 1]. @returns [°] */
  at: (part: number): number => DOG_RANGE * part ** 1.5 - DOG_START,
  /** @param offset - Azimuth less the least one [°]. @returns In [0, 1]; −1 before the first sample. */
  inverse: (offset: number): number =>
    offset < -DOG_START ? -1 : ((offset + DOG_START) / DOG_RANGE) ** (1 / 1.5)
}

/**
 * Azimuth of a sun dog's inner edge, from the sun: least deviation in a prism of 60° that stands upright.
 *
 * sin(½(Δ + 60°)) = ½ n′ with Bravais's index n′ = √(n² − sin² h)/cos h.
 *
 * @param elevation - Elevation h of the sun [°].
 * @see Tricker 1970, "Introduction to meteorological optics", ch. 4
 */
export function leastDogAzimuth(elevation: number): number {
  const sine = Math.sin((elevation * Math.PI) / 180)
  const index = Math.sqrt(RED_ICE ** 2 - sine ** 2) / Math.sqrt(1 - sine ** 2)
  return (2 * Math.asin(Math.min(index / 2, 1)) * 180) / Math.PI - 60
}
