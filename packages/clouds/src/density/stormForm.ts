// Constants of storms: layers of the weather of cumulonimbus alone. Each storm has a place and a shape of its own. All are seen
// in *Storm*, and most in the stills of 10 km.

/** Places of storms: jittered points of a lattice that the planet's surface cuts. */
export const stormPlaces = {
  /** Storms in a period of the fields' lattice. More: storms stand closer together, and are smaller. */
  cells: 9,
  /** Seed of their places. */
  seed: 977,
  /** Part of a cell that a storm may stand in. 1: walls where a storm reaches beyond the next cells; 0: rows. */
  jitter: 0.8,
  /** Extra distance of a storm whose point lies at a height z over the surface: its square is `away` z⁶ [cells]. Smaller: walls between storms. */
  away: 7.72,
  /** Lead of the nearest storm over the next below which both grow together [cells]. 0: creases where anvils meet; greater: sheets instead of storms. */
  merge: 0.25,
  /**
   * Scale [cells] and exponent [–] of the rank e^(−(d/scale)^power) of a distance d from the nearest storm, as counted over the planet.
   * Wrong: more or fewer storms than asked for.
   */
  scale: 0.49,
  power: 2.74,
  /** Least and greatest rank at a storm's rim: storms reach from 0 to 0.8 cells. */
  ranks: [0.03, 0.9999]
} as const

/** Shape of a storm: a tower under an anvil. Heights are parts of the layer's thickness. */
export const stormShape = {
  /** Radius of the tower over that of the anvil, and over the thickness at least [–]. Greater: a storm as wide as its anvil. */
  tower: 0.38,
  leastTower: 0.15,
  /**
   * Distance of the tower from the middle of its anvil, upwind, in radii of the anvil: per shear of the wind, and at most
   * [–]. 0: a mushroom whose tower stands in the anvil's shade.
   */
  aside: 2.25,
  mostAside: 0.5,
  /**
   * Lead of the nearest storm over the next from which turbulence bends it as other clouds, in bends of unit deviation [–]. Much less: folds and walls
   * midway between two storms; greater: storms that meet have straight seams (*Storm*).
   */
  steady: 10,
  /** Factors of the tower's radius at its base and at the top, under a full anvil [–]. */
  widening: [0.9, 1.15],
  /** Factors of a tower without an anvil [–]: a heap. As under an anvil: a block with upright sides (*Shower*). */
  narrowing: [1.15, 0.35],
  /** Height that the tower's dome reaches: it overshoots the anvil. */
  dome: 0.93,
  /** Height of the anvil, and its greatest depth above and below that. Greater above: a dome; greater below: a funnel. */
  anvil: 0.67,
  above: 0.09,
  below: 0.21,
  /** Length over which tower and anvil grow into each other. 0: a table on a leg. */
  blend: 0.12,
  /** Radius over the thickness between which storms get anvils, and from which they reach the layer's top [–]. */
  anvilFrom: [0.15, 0.4],
  grown: 0.4,
  /** Least height of a storm. */
  least: 0.2
} as const

/** Ice of storms: towers are of water up to their domes, and anvils thin out towards their rims. */
export const stormIce = {
  /** Distances from a tower's axis between which water turns into the ice of its anvil, in radii of that anvil. 0: domes of wool. */
  aside: [0.35, 0.8],
  /** Width of an anvil's thin rim, in its radii [–]. 0: its edge is a cliff (*Storm*). */
  rim: 0.6,
  /**
   * Factor of that width: the distance from the tower, in the anvil's radii, between these. Ice that has streamed far is thin. Both 1: anvils alike
   * up and down the wind (*Storm*).
   */
  streaming: [0.5, 1.6],
  /** Distance from the anvil's axis where the rim ends, in its radii [–]. Less: fibres are cut off there (*Storm*). */
  end: 1.1,
  /** Least square root of the rim's density [–]. 0: fibres beyond its end are not seen (*Storm*). */
  least: 0.1
} as const

/** Fibres of anvils: noise in coordinates about the tower, from which the ice streams outwards. */
export const stormFibres = {
  /** Periods of the shape's noise in a radian about the tower. More: narrower fibres. */
  around: 2,
  /** Distance from the tower within which fibres are no narrower than there [cells]. 0: they burst from a point, where a storm has no tower (*Storm*). */
  core: 0.15,
  /** Length of a period outwards, and upwards [m]: fibres sink by the ratio of both as they go. Shorter outwards: heads, not fibres. */
  outwards: 24_000,
  upwards: 4000,
  /** Weights of coarse and fine billows in them [–]. Greater fine ones: grain at rims. */
  weights: [0.7, 0.55],
  /** Levels of detail by which they are looked up sharper than billows are [octaves]. Greater: grain at rims; smaller: wool. */
  sharper: 0.5,
  /** Displacement of the rim per unit of them, and at most, in radii of the anvil [–]. 0: a rim like a tower's; greater: loose rags. */
  fray: 0.1,
  mostFray: 0.2,
  /** Lead of the nearest storm over the next at which they are whole, in its radii [–]. 0: seams where two storms meet (*Storm*). */
  lead: 0.3,
  /** Distances from the anvil's axis within which rims are, in its radii [–]. */
  rim: [0.4, 1.3]
} as const

/** Billows of storms, in units of strength per deviation of their noise: displacements outwards and inwards. */
export const stormBillows = {
  /** Length that strength changes by 1 over [periods of the shape]. Smaller: hard edges. */
  unit: 0.02,
  /** Coarse, fine and finest billows [–]: slopes of about 1 make heads that stand on heads. Greater: rags; smaller: balloons. */
  coarse: 3,
  fine: 0.8,
  detail: 0.3,
  /** Factor of all of them in ice [–]: anvils are smooth. */
  inIce: 0.4,
  /** Softness of edges in ice: factor of their width less 1 [–]. */
  softIce: 8,
  /** Strength below which billows add nothing to clear air; they fade towards it [–]. Greater: islands float beside storms. */
  reach: 13,
  /** Strength that is taken off: billows cover more than they clear [–]. Smaller: storms cover more than asked for. */
  offset: 0,
  /** Most that billows and turbulence add to strength in clear air [–]. Smaller: faster, and heads are cut off. */
  most: 13
} as const
