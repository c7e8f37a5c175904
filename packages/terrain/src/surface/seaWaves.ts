/** Period of the waves' pattern along each axis of ECEF: a step of references [m]. */
export const PERIOD = 256

/** Longest and shortest wave [m], and their number. */
const LONGEST = 14
const SHORTEST = 0.45
const COUNT = 24

/** Part of the sea's slopes that these waves have; the rest are ripples that no pixel shows. */
export const WAVE_SHARE = 0.5

/** Turn from a wave's direction to the next: the golden angle [rad]. */
const TURN = Math.PI * (3 - Math.sqrt(5))

/** Gravity [m/s²]. */
export const GRAVITY = 9.81

/** A wave of the sea. */
export interface SeaWave {
  /** Direction times periods in 256 m, ECEF axes: whole numbers, so that the pattern has no seam. */
  readonly vector: readonly [number, number, number]
  /** Wavelength [m]. */
  readonly length: number
  /** Periods in a second, in deep water [1/s]. */
  readonly frequency: number
}

/**
 * Domain warp of the waves: displacement along each axis of ECEF, a sine along a direction of its own, in periods in 256 m; a symmetric
 * matrix. Without it the few waves that show far away make a lattice (*Terrain*, lake).
 */
export const WARPS = [
  [-2, 5, 3],
  [5, 1, -4],
  [3, -4, 2]
] as const

/** Amplitude of a displacement [m]. */
export const WARP = 3.2

/** Mean square of the waves' slopes over that without the warp, 1 + |W|² (2π WARP / PERIOD)² / 6 with W the matrix of WARPS. */
export const WARPED = 1.112

/**
 * Waves of the sea, the longest first, from all directions of space: those along the ground count on each part of the planet.
 *
 * Frequencies are those of gravity waves in deep water, f = √(g / 2πλ).
 */
export const SEA_WAVES: readonly SeaWave[] = Array.from({ length: COUNT }, (_, i) => {
  const wanted = LONGEST * (SHORTEST / LONGEST) ** (i / (COUNT - 1))
  // Even over the sphere, in an order in which neighbours in length differ in direction.
  const place = (i * 5) % COUNT
  const z = ((place + 0.5) / COUNT) * 2 - 1
  const level = Math.sqrt(1 - z * z)
  const unit = [level * Math.cos(TURN * place), level * Math.sin(TURN * place), z]
  const vector = unit.map(part => Math.round((part * PERIOD) / wanted)) as [number, number, number]
  const length = PERIOD / Math.hypot(...vector)
  return { vector, length, frequency: Math.sqrt(GRAVITY / (2 * Math.PI * length)) }
}).sort((a, b) => b.length - a.length)

/**
 * Steepest slope of each wave, over the square root of the sea's variance of slopes: a wave from anywhere has two thirds of its square along the
 * ground, and half of that on average.
 */
export const WAVE_SLOPE = Math.sqrt((3 * WAVE_SHARE) / COUNT / WARPED)

/**
 * Mean square slope of the sea's surface in a wind.
 *
 * @param windSpeed - 12.5 m above the water [m/s].
 * @see Mobley 2021, "Ocean Optics Web Book", "Cox-Munk sea surface slope statistics", after Cox & Munk 1954,
 * "Measurement of the roughness of the sea surface from photographs of the sun's glitter"
 */
export const seaSlopeVariance = (windSpeed: number): number => 0.003 + 5.12e-3 * windSpeed
