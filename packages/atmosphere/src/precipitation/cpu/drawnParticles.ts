import type { ParticleKind } from '../ParticleKind'
import { numberBetween, type SizeDistribution } from './sizes'

/** Side of a class's box over its reach: it holds all that a camera sees up to there, whichever way it turns. */
export const BOX_SIDE = 1.5

/** Sizes that particles are drawn from, and those at a rate [mm/h]: at 0 there are none. */
export function drawnSizes(
  { sizes, drawnRate }: ParticleKind,
  rate: number
): { drawn: SizeDistribution; there: SizeDistribution } {
  const drawn = sizes(drawnRate)
  return { drawn, there: rate > 0 ? sizes(rate) : { intercept: 0, slope: drawn.slope } }
}

/** Particles of a class of size that are drawn. */
export interface DrawnClass {
  /** Side of the box [m]. */
  readonly side: number
  /** Particles of the box of the drawn rate's sizes, over {@link weight} [–]. */
  readonly proposed: number
  /** Particles that the graphics unit goes through: those that are there at this rate are among the first. */
  readonly count: number
  /** Real particles for which each one stands, ≥ 1. */
  readonly weight: number
}

/**
 * Particles to draw at a rate.
 *
 * @param rate - [mm/h]; 0 has none.
 * @param most - Most particles of a class.
 */
export function drawnParticles(kind: ParticleKind, rate: number, most: number): DrawnClass[] {
  const { drawn, there } = drawnSizes(kind, rate)
  return kind.reach.map((reach, i) => {
    const [from, to] = [kind.edges[i], kind.edges[i + 1]]
    const side = BOX_SIDE * reach
    const proposed = numberBetween(drawn, from, to) * side ** 3
    const share = (diameter: number): number =>
      (there.intercept / drawn.intercept) * Math.exp((drawn.slope - there.slope) * diameter)
    const needed = proposed * Math.max(share(from), share(to))
    const weight = Math.max(kind.weights[i], needed / most)
    return {
      side,
      proposed: proposed / weight,
      count: Math.min(Math.ceil(needed / weight), most),
      weight
    }
  })
}

/**
 * Distance over a class's reach up to which it keeps a share of its particles, in (0, 1] [–].
 *
 * @param fullReach - `ParticleKind.fullReach` of the class.
 * @param share - In [0, 1].
 */
export const keptReach = (fullReach: number, share: number): number =>
  Math.min(fullReach / Math.sqrt(share), 1)
