import { DOG_RANGE, DOG_START, RED_ICE } from '../../src/optics/cpu/sunDogs'

/** Tilt of plates that float level: standard deviation along either axis [°]. */
export const PLATE_TILT = 1

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
 */
export function leastDogAzimuth(elevation: number): number {
  const sine = Math.sin((elevation * Math.PI) / 180)
  const index = Math.sqrt(RED_ICE ** 2 - sine ** 2) / Math.sqrt(1 - sine ** 2)
  return (2 * Math.asin(Math.min(index / 2, 1)) * 180) / Math.PI - 60
}
