import { float } from 'three/tsl'
import { raindropSizes, snowflakeSizes, type SizeDistribution } from './cpu/sizes'
import type { Float } from '../tsl-types'

/** Drops or flakes. Diameters are those of the drop of water that a particle is or melts to [mm]. */
export interface ParticleKind {
  /** Name of the class, for errors. */
  readonly name: string
  /** Sizes at a rate [mm/h]. */
  readonly sizes: (rate: number) => SizeDistribution
  /** Rate whose sizes particles are drawn from, so that each keeps its own while the rate changes [mm/h]. */
  readonly drawnRate: number
  /** Edges of the classes of size, as diameters [mm]: particles below the first are too faint to be seen. */
  readonly edges: readonly [number, number, number, number, number]
  /** Distance up to which a class is drawn [m]: farther off its particles are too faint. */
  readonly reach: readonly [number, number, number, number]
  /** Least number of real particles for which each drawn one stands: those of small classes are too faint to be told apart. */
  readonly weights: readonly [number, number, number, number]
  /**
   * Share of its reach up to which a class has all its particles: farther off fewer and more opaque ones stand for them. Smaller: opacities would
   * be above 1, and far snow too thin (*Rain and snow in a street*).
   */
  readonly fullReach: readonly [number, number, number, number]
  /** Most particles of a class that are drawn, by default. */
  readonly most: number
  /** Width that is seen [m]. @param diameter - [mm]. */
  readonly width: (diameter: Float) => Float
  /** Speed of fall in still air [m/s]. @param diameter - [mm]. */
  readonly speed: (diameter: number) => number
  /** Mean speed of fall, along which roofs are seen [m/s]. */
  readonly meanSpeed: number
  /** Sideways flutter: amplitude [m] and mean frequency [Hz]. */
  readonly flutter: readonly [amplitude: number, frequency: number]
  /** Unevenness of the outline, in [0, 1) [–]. */
  readonly unevenness: number
  /** True for what thins out towards its edge. */
  readonly isSoft: boolean
  /**
   * Phase function without what is diffracted: concentration κ of the forward lobe, e^{−κ(1 − cos θ)}, and share of the
   * light that goes evenly into all directions.
   */
  readonly phase: readonly [concentration: number, even: number]
}

/**
 * Rain.
 *
 * Speeds: Gunn & Kinzer 1949, as Atlas et al. 1973 fitted them ("Doppler radar characteristics of precipitation at vertical
 * incidence", eq. 4). Phase function: fitted to that of rays through a sphere of water, within 15 % up to 60°.
 */
export const rain: ParticleKind = {
  name: 'Rainfall',
  sizes: raindropSizes,
  drawnRate: 100,
  edges: [0.5, 1, 2, 3, 6],
  reach: [2, 4, 8, 16],
  weights: [4, 2, 1, 1],
  fullReach: [0.35, 0.35, 0.35, 0.35],
  most: 32_768,
  width: diameter => diameter.mul(1e-3),
  speed: diameter => Math.max(9.65 - 10.3 * Math.exp(-0.6 * diameter), 0),
  meanSpeed: 6.5,
  flutter: [0, 1],
  unevenness: 0,
  isSoft: false,
  phase: [8.3, 0.12]
}

/** Width of the flake that melts to a drop of diameter D, by ρ_s D³ = ρ_w D_m³: factor [mm] and power of D/mm. */
const FLAKE = [2.295, 1.4437] as const

/**
 * Snow: aggregates of dendrites.
 *
 * Widths: by the density of flakes, 178 kg/m³ (D/mm)^−0.922 (Brandes et al. 2007, "A statistical and physical description of
 * hydrometeor distributions in Colorado snowstorms", eq. 7). Speeds: 0.8 (D/mm)^0.16 m/s (Locatelli & Hobbs 1974, table 1).
 */
export const snow: ParticleKind = {
  name: 'Snowfall',
  sizes: snowflakeSizes,
  drawnRate: 3,
  edges: [0.3, 0.8, 1.6, 2.6, 5],
  reach: [2.5, 5, 10, 18],
  weights: [2, 1, 1, 1],
  fullReach: [0.35, 0.35, 0.5, 0.75],
  most: 65_536,
  width: diameter =>
    float(diameter)
      .pow(FLAKE[1])
      .mul(1e-3 * FLAKE[0]),
  speed: diameter => 0.8 * (FLAKE[0] * diameter ** FLAKE[1]) ** 0.16,
  meanSpeed: 1,
  flutter: [0.03, 1.1],
  unevenness: 0.3,
  isSoft: true,
  phase: [3, 0.35]
}
