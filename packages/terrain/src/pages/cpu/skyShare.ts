/** Azimuths in which horizons are looked for. */
export const AZIMUTHS = 4

/** Distances at which they are looked for, the nearest of them [m], and how many times the one before each is. */
export const DISTANCES = 2
export const NEAREST = 150
export const FARTHER = 8

/** Shortest wavelength that counts, as a fraction of the distance [–]. */
export const FINENESS = 0.3

/**
 * Float64 twin of the share of the sky, by angles in place of slopes.
 *
 * @param heightAt - Height at a place east and north of here [m].
 * @param slopeEast - Slope of the ground here, rise over run, as `slopeNorth`.
 * @returns In (0, 1].
 */
export function skyShare(
  heightAt: (east: number, north: number) => number,
  slopeEast: number,
  slopeNorth: number
): number {
  const here = heightAt(0, 0)
  let sum = 0
  for (let azimuth = 0; azimuth < AZIMUTHS; azimuth++) {
    const angle = (2 * Math.PI * azimuth) / AZIMUTHS
    const [sine, cosine] = [Math.sin(angle), Math.cos(angle)]
    let elevation = 0
    for (let ring = 0; ring < DISTANCES; ring++) {
      const distance = NEAREST * FARTHER ** ring
      const own = (slopeEast * sine + slopeNorth * cosine) * distance
      const rise = heightAt(distance * sine, distance * cosine) - here - own
      elevation = Math.max(elevation, Math.atan2(rise, distance))
    }
    sum += Math.cos(elevation) ** 2
  }
  return sum / AZIMUTHS
}
