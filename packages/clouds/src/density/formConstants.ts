// Constants of the cloud field that were found by looking. Each says what one sees when it changes, and in
// which story of stories/src/clouds.stories.ts.

/** Constants of column strength and filtered coverage: tsl/strength.ts, tsl/weather.ts. */
export const strengthForm = {
  /**
   * Strength of the strongest columns [–]: cumulus that reach the layer's top. Greater: steeper sides, and
   * more towers of the same height (*Cumulus*).
   */
  strongest: 3.5,
  /** Least coverage that strength is scaled by [–]. Smaller: a coverage near 0 leaves needles (*Presets*). */
  leastCoverage: 0.02,
  /**
   * Added to the strength for the shape amount s and coverage c: s (a + b c) + d c³² [–]. It makes a layer
   * cover what its coverage says, billows and all, and closes it at full coverage. Greater: more cloud than asked for; less of
   * the last: holes in an overcast (*Presets*).
   */
  offset: -0.13,
  coverageOffset: 0.61,
  fullCoverageExcess: 1.7,
  /**
   * Offset where levels of detail have lost the billows, for shape amount 1 [–], and the unresolved
   * fraction at which it is 0. Greater: more cloud far away than near by (*Cockpit*).
   */
  smoothOffset: 0.82,
  smoothUntil: 1,
  /**
   * Levels of detail over which billows are lost in the mean [octaves]: the offset goes with them. Wrong:
   * clouds grow or shrink with the distance (*Cockpit*).
   */
  billowLevels: [1, 4.6],
  /**
   * Levels of detail over which single clouds are lost in the mean [octaves]. It says how much variance
   * blurred weather has left: wrong, and cover changes with the distance (*World clouds*).
   */
  fadeLevels: 6,
  /**
   * Levels of detail of the weather's noise for each octave by which a footprint is wider than its texels. 1: grain of a pixel or two
   * from orbit; greater: the weather blurs with the distance (*World clouds*, without its map).
   */
  levelsPerOctave: 1.25,
  /** Least variance of blurred weather: what is lost beyond that is not restored [–]. Smaller: grain far away (*World clouds*). */
  leastVariance: 0.05,
  /**
   * Width of the edges of the filtered coverage, in standard deviations of the weather: per shape amount, and at least [–]. Greater: fields
   * of clouds have soft rims from orbit (*World clouds from 12,000 km*).
   */
  edgeSoftness: 0.4,
  leastEdgeSoftness: 0.05,
  /**
   * Contrast of the filtered coverage about ½ [–]: regions are wholly clear and wholly closed. Its distribution has longer
   * tails than clouds have. Greater: clear zones with hard rims from orbit (*World clouds from 12,000 km*, without its map).
   */
  contrast: 1.002
} as const

/** Constants of the strength that a column needs to reach a height: tsl/heightForm.ts. */
export const heightForm = {
  /** Strength that is needed at the top of a layer [–]. Greater: flat clouds (*Cumulus*). */
  top: 3.2,
  /**
   * Inversion: height in the layer from which more is needed, in [0, 1], and how much, per square of the
   * height above it. Weaker: single towers stand out at the layer's top, cut off by it (*Cumulus*).
   */
  inversion: 0.72,
  inversionStrength: 17,
  /**
   * Strength that a column needs at the base of a layer with relief [–]. Greater: bases rise in strong columns,
   * too, and a ceiling has holes (*Presets*).
   */
  relief: 5,
  /** Height in the layer up to which extinction grows, in [0, 1]. Greater: dull middles (*Cumulus*). */
  grown: 0.73,
  /**
   * Strength that towers need below an anvil, on top of the anvil's own [–], and heights between which they spread,
   * in [0, 1]. Smaller: a storm as wide as its anvil from the base on (*Storm*).
   */
  tower: 2.6,
  towerHeights: [0.3, 0.68],
  /** Strength that anvils need all over [–]: greater, and a storm covers less than it is asked to (*Storm*). */
  anvil: 1.15,
  /** Height at which anvils end, in [0, 1], and the strength needed there. Smaller: what overshoots covers the
   * anvil like a second deck (*Storm*). */
  anvilHeights: [0.72, 1],
  overshoot: 4.6,
  /**
   * Heights between which water freezes, in [0, 1], and extinction of ice over that of water. Greater: anvils as hard as towers
   * (*Storm*).
   */
  iceHeights: [0.4, 0.72],
  iceDensity: 0.16
} as const

/** Constants of billows and detail: tsl/billows.ts. */
export const billowForm = {
  /**
   * Footprints that billows and detail are looked up by, over a sample's [–]: heads of a pixel or two are no heads, but grain.
   * Greater: far clouds of clay; 1: of moss (*Cockpit*).
   */
  footprints: 2.5,
  detailFootprints: 1.4,
  /** Strength of coarse, fine and finest billows, per deviation of their noise [–]. Greater: ragged (*Cumulus*). */
  coarse: 0.76,
  fine: 1.55,
  detail: 0.4,
  /** Change of the same from a layer's base to its top, about their mean [–]. 0: bases like tops (*Cumulus*). */
  coarseGrowth: 0.337,
  fineGrowth: 0.2,
  /**
   * Strength of a column, less what a height needs, over which coarse billows come to bulge out of it [–]. Lower: heads without stems float
   * beside towers; higher: smooth towers (*Cumulus*).
   */
  bulgeFrom: [-1.88, -0.68],
  /** Needed strength over which that comes to count [–]: near the base small clouds are bulges alone. */
  bulgeAbove: [0.3, 1],
  /**
   * Strength from which on fine billows are whole, and range below it over which they set in [–]: bodies have
   * them, crumbs do not. Lower: crumbs float about clouds (*Cumulus*).
   */
  fineFrom: 0.02,
  fineOver: 0.8,
  /**
   * Strength of columns over which all their billows grow weaker, and the factor they end at [–]: only the top
   * of a strong column is an edge, and it is a round head. Factor 1: tops torn to shreds (*Cumulus*).
   */
  middle: [0.3, 1.6],
  atTops: 0.6,
  /** Height in the layer below which detail makes wisps, not billows, in [0, 1]. 0: bases of small balls (*Cumulus*). */
  wispHeight: 0.1,
  /**
   * Displacement of the weather's look-up by turbulence, for a curl of unit deviation [periods of the
   * shape], and heights in the layer over which it sets in, in [0, 1]. 0: columns like cookies (*Cumulus*).
   */
  bend: 0.045,
  bendHeight: 0.2
} as const

/** Constants of density: tsl/density.ts. */
export const densityForm = {
  /**
   * Strength over which density rises at crisp edges, and the factor for wholly soft ones [–]. Greater: clouds of wool; smaller:
   * of plaster (*Cumulus*).
   */
  crispEdge: 0.15,
  softEdge: 12,
  /** Softer edges at the base than at the top: factor of their width less 1 [–]. 0: bases like tops (*Cumulus*). */
  softerBase: 9.2,
  /**
   * Factor of the density of what only billows make cloud, and the strength of columns without them over which
   * it rises to 1 [–], less a share of what the height needs: decaying bits are thin. Factor 1: confetti about
   * clouds; greater share: thin tops (*Cumulus*).
   */
  crumb: 0.2,
  crumbFrom: [-1.05, -0.25],
  crumbHeight: 0.4
} as const

/** Clouds that are not seen one by one, as mean columns: tsl/unresolved.ts. */
export const columnForm = {
  /**
   * Factor [–] of a layer's thickness over the weather's period: the product, at most 1, is the share of what
   * tall bodies hide more of when looked at aslant. Smaller: far fields of cumulus show the ground between
   * them at the horizon (*Cockpit*).
   */
  slantAspect: 5,
  /** Share of that in storms, whose anvils are flat [–]. Greater: storms are too many and too bright from afar, aslant. */
  slantOfStorms: 0.1,
  /**
   * Factor of the share of columns that reach a height [–]. Smaller: clouds are darker from afar (*World
   * clouds*).
   */
  tops: 1.5,
  /**
   * Height up to which less and less of clouds is seen towards their bases, in [0, 1], without an anvil and
   * with one, and the least share. Smaller: clouds are darker from above, and too bright at the limb (*World clouds*).
   */
  hiddenBelow: 0.45,
  hiddenByAnvil: 1,
  leastSeen: 0.3,
  /**
   * Density inside of columns, as light meets it, over what tall ones have in the mean [–]. Smaller: thin clouds
   * that are dark from afar (*World clouds*).
   */
  inside: 1.25,
  /** Factor of the same in storms, of which much is in the shade of their anvils [–]. Greater: storms are too bright from afar. */
  insideStorms: 0.75
} as const
