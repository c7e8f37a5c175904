// Constants of the cloud field that were found by looking. Each says what one sees when it changes, and in
// which story of stories/src/clouds.stories.ts.

/** How weather becomes the strength of a column: `columnStrength` of tsl/weather.ts. */
export const strengthForm = {
  /**
   * Change of the weather over which a column goes from edge to middle [–]. Greater: clouds thin out
   * slowly towards their edges, and their tops get rounder (*Cumulus*).
   */
  edgeWidth: 0.5,
  /** The same for cirrus. Smaller: fibres become solid bands with edges (*Cirrus*). */
  cirrusEdgeWidth: 1.6,
  /**
   * Strength at which noise puts the edge on average, per shape amount [–]. It makes a layer cover what
   * its coverage says: greater, and all skies have more cloud than they ask for (*Presets*).
   */
  meanEdge: 0.535,
  /**
   * Added to the strength at full coverage, taken at none [–]. Smaller: `overcast` gets holes, and a
   * coverage of nearly 0 leaves crumbs (*Presets*).
   */
  fullCoverageExcess: 0.6,
  /**
   * Levels of detail over which single clouds are lost in the mean [octaves]. It says how much variance
   * blurred weather has left: wrong, and cover changes with the distance (*World clouds*).
   */
  fadeLevels: 5,
  /** Least variance of blurred weather that is made up for [–]. Smaller: grain far away (*World clouds*). */
  leastVariance: 0.05,
  /**
   * Deviation of the weather by which edges of the filtered coverage are soft: per shape amount, and at
   * least [–]. Greater: fields of clouds have soft rims from orbit (*World clouds from afar*).
   */
  edgeSoftness: 0.4,
  leastEdgeSoftness: 0.05
} as const

/** How tall towers spread into anvils, with an anvil of 1: tsl/profile.ts. All are seen in *Storm*. */
export const anvilForm = {
  /** Heights in the layer between which towers become anvils, in [0, 1]. Lower: thick anvils. */
  heights: [0.62, 0.8],
  /** Strength that towers lack below their anvils [–]. Greater: slender towers. */
  narrowing: 0.4,
  /** Density of anvils over that of towers, in [0, 1]. Smaller: the sky shines through anvils. */
  density: 0.35,
  /** Mean over all heights of a far anvil's profile times its density: columns far away keep theirs. */
  profileMean: 0.09
} as const

/** What noise takes away: tsl/erosion.ts. */
export const erosionForm = {
  /**
   * Least shape erosion, per shape amount [–]: what has less in its dimensional profile is empty for sure.
   * Greater: longer steps through clear air, and flatter billows inside of clouds (*Inside a cloud*).
   */
  leastShape: 0.15,
  /** Weight of the finer billows against the first ones [–]. Greater: small lumps all over (*Cumulus*). */
  finerBillows: 0.3,
  /**
   * Shape erosion that is left out where levels of detail have lost the billows, per shape amount [–], and
   * over how many levels [octaves]. Smaller: clouds shrink with the distance (*Cockpit*).
   */
  filteredShape: 0.09,
  fadeLevels: 5,
  /** Most that detail takes away [–]. Greater: ragged edges, and holes in thin clouds (*Cumulus*). */
  mostDetail: 0.22,
  /**
   * Heights in the layer between which the detail turns from wisps to billows, in [0, 1]. Higher: tops
   * have wisps, too (*Cumulus*).
   */
  wispHeights: [0.1, 0.35],
  /**
   * Density per what erosion leaves of the dimensional profile, of smooth layers and of eroded ones [–].
   * Greater: harder edges, which need shorter steps (*Cumulus*).
   */
  smoothSharpness: 1.5,
  erodedSharpness: 6
} as const

/** Clouds that are not seen one by one, as mean columns: tsl/unresolved.ts. */
export const columnForm = {
  /**
   * Mean density of a cloudy column over the densest: of most clouds, and where all towers have anvils,
   * since most of these is thin [–]. Wrong: clouds get brighter or darker where they turn into a mean, a
   * ring about the viewpoint (*World clouds*).
   */
  density: 0.6,
  anvilDensity: 0.12,
  /**
   * The same of fibrous clouds, by coverage c: a₀ + a₁c² + a₂c⁶⁴ [–]. Fitted to columns of resolved
   * cirrus.
   */
  fibrousDensity: [0.05, 0.15, 0.35],
  /**
   * Height over the weather's period, times this: how much clouds hide, looked at aslant, as tall bodies
   * would. Smaller: far fields of cumulus show the ground between them at the horizon (*Cockpit*).
   */
  slantAspect: 5
} as const
