// Constants of the density function, found by looking at its pictures.

/** Change of the weather over which a layer fills from edge to middle: of any cloud but cirrus, and of that. */
export const edgeWidth = 0.5
export const cirrusEdgeWidth = 1.6

/** Fill where noise puts the edge on average, per shape amount: it makes coverage what it says. */
export const meanEdge = 0.535

/** Added to the fill at full coverage, taken at none. */
export const excess = 0.6

/** Levels of detail over which single clouds are lost in the mean. */
export const blur = 5

/** Least variance of blurred weather that is made up for. */
export const leastVariance = 0.05

/** Deviation of the weather by which edges of the cover are soft: by the shape, per amount, and at least. */
export const carvedBlur = 0.4
export const leastBlur = 0.05

/** Fill that towers lack below their anvils, and how much thinner these are. */
export const anvilReach = 0.4
export const anvilDensity = 0.35

/** The shape carves at least this part of its amount: what is less full is empty for sure. */
export const leastCarving = 0.15

/** What the shape carves less where its levels of detail have lost it, per amount, and over how many levels. */
export const lostCarving = 0.09
export const shapeBlur = 5

/** Most that detail takes away. */
export const erosion = 0.22

/** Density per fullness left, of smooth layers and of carved ones: how sharp edges are. */
export const smoothSharpness = 1.5
export const carvedSharpness = 6

/** Mean density of a cloudy column over the densest; where towers have anvils, most of it is thin. */
export const solidFill = 0.6
export const anvilFill = 0.12

/** Mean over all heights of anvils, by how full and how dense they are. */
export const anvilMean = 0.09

/** Height over the weather's period, times this: how much clouds hide, looked at aslant, as a slab would. */
export const tallness = 5

/** The same as `solidFill` of fibrous clouds, by cover c: a₀ + a₁c² + a₂c⁶⁴; fitted to columns seen from near. */
export const thinFibres = 0.05
export const moreFibres = 0.15
export const mostFibres = 0.35
