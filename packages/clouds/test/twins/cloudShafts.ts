/** A cloud deck over a sphere, for the shadow that it casts into the air. */
export interface ShadingDeck {
  /** Radius of the planet, and altitudes of base and top of the deck [m]. */
  readonly planetRadius: number
  readonly base: number
  readonly top: number
  /** Extinction at a place by its offset from the eye's subpoint: up, east and north [1/m]. */
  readonly extinction: (up: number, east: number, north: number) => number
}

/** Steps of the march through the deck. */
const STEPS = 600

/**
 * Optical depth of a deck between a point of the air in the plane of zenith and sun, and the sun: an even march through the deck alone.
 *
 * @param up - Height over the plane that touches the planet at the eye's subpoint [m].
 * @param north - Towards the sun [m].
 * @param elevation - Angle of the sun over that plane [rad].
 */
export function depthToSun(
  { planetRadius, base, top, extinction }: ShadingDeck,
  up: number,
  north: number,
  elevation: number
): number {
  const [rise, run] = [Math.sin(elevation), Math.cos(elevation)]
  const squared = (planetRadius + up) ** 2 + north ** 2
  const radial = (planetRadius + up) * rise + north * run
  /** Distance to where the ray leaves a sphere about the planet's centre, ≥ 0 [m]. */
  const leaves = (altitude: number): number => {
    const inside = (planetRadius + altitude) ** 2 - squared
    return Math.max(-radial + Math.sqrt(Math.max(radial ** 2 + inside, 0)), 0)
  }
  const isAbove = Math.sqrt(squared) > planetRadius + top
  const [from, to] = isAbove ? [0, 0] : [leaves(base), leaves(top)]
  let sum = 0
  for (let i = 0; i < STEPS; i++) {
    const distance = from + ((to - from) * (i + 0.5)) / STEPS
    sum += extinction(up + rise * distance, 0, north + run * distance)
  }
  return (sum * (to - from)) / STEPS
}
