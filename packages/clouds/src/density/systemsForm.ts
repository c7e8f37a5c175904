// Constants of the weather of whole regions: fronts, cyclones, belts. Lengths are chords of the unit sphere [–]: 0.1 is 640 km.
// All are seen in *World clouds from 12,000 km*, without its map.

/** Degrees to radians. */
const DEGREE = Math.PI / 180

/**
 * A cyclone of the middle latitudes.
 *
 * @param longitude - Longitude [°].
 * @param latitude - Latitude [°].
 * @param radius - Radius of the air that it turns [–].
 * @param turn - Angle by which its middle has been turned [rad]. Greater: more windings.
 * @param front - Direction of its cold front before it was turned, from the east against the clock [°].
 */
const cyclone = (
  longitude: number,
  latitude: number,
  radius: number,
  turn: number,
  front: number
) => {
  const across = Math.cos(latitude * DEGREE)
  const centre = [
    across * Math.cos(longitude * DEGREE),
    across * Math.sin(longitude * DEGREE),
    Math.sin(latitude * DEGREE)
  ] as const
  return { centre, radius, turn, front: front * DEGREE }
}

/** Cyclones of the northern half; those of the southern one are their mirror images, turned about the axis. */
export const cyclones = [
  /*#__PURE__*/ cyclone(12, 52, 0.3, 2.3, 222),
  /*#__PURE__*/ cyclone(68, 43, 0.25, 1.5, 228),
  /*#__PURE__*/ cyclone(119, 57, 0.28, 2.7, 238),
  /*#__PURE__*/ cyclone(183, 46, 0.31, 2, 224),
  /*#__PURE__*/ cyclone(243, 54, 0.28, 2.6, 236),
  /*#__PURE__*/ cyclone(300, 42, 0.3, 1.7, 218)
] as const

/** Turn of the southern half's cyclones about the axis [rad]. 0: both halves alike. */
export const SOUTHERN_TURN = 29 * DEGREE

/** Fronts of a cyclone, in the air as it was before it turned them. */
export const frontForm = {
  /** Length, and half widths of its clouds ahead and behind [–]. Greater: broad arms. */
  cold: { reach: 0.42, ahead: 0.085, behind: 0.037 },
  warm: { reach: 0.22, ahead: 0.1, behind: 0.05 },
  /** Angle from the cold front to the warm one [rad]. */
  between: 2,
  /** Distance behind the cold front of the dry air that follows it, its half width [–], and what it takes. 0: no clear slot. */
  dry: { behind: 0.1, width: 0.1, strength: 1 },
  /** Radius of the clouds about the middle [–]. */
  head: 0.13,
  /** Strength of its clouds; of the warm front's and of the middle's, over the cold one's [–]. */
  strength: 1.9,
  warmStrength: 0.8,
  headStrength: 0.8,
  /** Factor of its share: whole where more than 1 over this of its turn is left. Greater: long tails. */
  rim: 2.2,
  /** Shift by the regions [–]. 0: smooth arms. */
  ragged: 0.07
} as const

/** Belts of latitude, by the sine of the latitude. */
export const beltForm = {
  /** Shift of the belts by two of the planet's waves, and by the regions [–]. 0: straight belts. */
  waves: [0.045, 0.03],
  ragged: 0.1,
  /** Convergence zones of the trade winds: sine of the latitude, half width, strength. */
  convergence: [
    [0.1, 0.1, 1.4],
    [-0.08, 0.085, 0.85]
  ],
  /** Their patches: mean, by the regions, by a wave; least and most [–]. */
  patches: { mean: 0.75, regions: 1.1, wave: 0.45, least: 0.1, most: 1.5 },
  /** Sinking air: where it sets in and ends, and what it takes. Greater: no clouds in the subtropics. */
  sinking: { from: [0.14, 0.3], to: [0.5, 0.7], strength: 1.15 },
  /** Decks in it: sine of the latitude, half width, waves over which they set in, strength. */
  decks: { latitude: 0.38, width: 0.17, from: [0.1, 0.8], strength: 1.5 },
  /** Westerlies: where they set in, strength. */
  westerlies: { from: [0.55, 0.72], strength: 0.3 }
} as const

/**
 * Mean of fronts and belts over the planet, and divisor of what is left: more
 * than their deviation, 0.72, since they go along with the regions' noise and are not normally distributed. Wrong: more or fewer
 * clouds than asked for.
 */
export const systemsStatistics = [-0.157, 0.88] as const
