import { If, float, mix, vec2, vec4 } from 'three/tsl'
import { select } from '../../select'
import { LEAST_TRANSMITTANCE } from '../../light/tsl/lighting'
import { componentAt } from '../../density/tsl/componentAt'
import type { Float, Variable, Vec2, Vec4 } from '../../tsl-types'

// What a ray sees of the clouds, as a few points that stand for all of it: light is computed there, in a pass
// of its own (shadePoints.ts), so that the march stays small and its rays stay together.

/**
 * Most points of a ray, each for a stratum of its opacity: equal ones of its root, since light changes most just
 * inside of clouds. More: light takes longer; fewer: flat, banded insides
 * (*Inside a cloud*).
 */
export const POINTS = 4

/**
 * Share of a ray's light from which a stratum is left to its cloud or its layer, and the next one gets one of its
 * own [–]. Greater: contours where clouds stand before each other (*Cockpit*); smaller: wisps use all points up.
 */
const LEAST_SHARE = 0.02

/**
 * Gap between clouds from which they count as apart: part of the distance, and at least [m]. The light of a
 * point between two clouds would be that of neither. Greater: light rims where one cloud stands before another (*Cumulus*).
 */
const GAP_GROWTH = 0.02
const LEAST_GAP = 60

/** Points that stand for all that a ray sees of the clouds, from the camera outwards. */
export interface SeenPoints {
  /** Their distances from the camera [m]. */
  readonly distances: Vec4
  /** Parts of the ray's light that come from what they stand for; 0 for none. Their sum is the opacity. */
  readonly shares: Vec4
  /**
   * Part of the light that casters besides the clouds leave to one of them, in [0, 1]: that with 1 in its component, at its distance.
   * Left out, all.
   */
  readonly lit?: (own: Vec4, distance: Float) => Float
}

/** State of a ray's strata so far. */
export interface SeenState {
  readonly transmittance: Variable<Float>
  readonly distances: Variable<Vec4>
  readonly shares: Variable<Vec4>
  /** Index of the stratum that the ray is in. */
  readonly index: Variable<Float>
  /** The present cloud's part of the stratum: its share, and the sum of its distances by share. */
  readonly run: Variable<Vec2>
  /** Greatest share of a cloud in the stratum so far. */
  readonly most: Variable<Float>
  /** Distance of the last sample that was added [m]. */
  readonly latest: Variable<Float>
  /** Sum of distances by opacity [m]. */
  readonly weightedDistance: Variable<Float>
}

/** A ray that has met nothing yet. To be called inside of a shader function. */
export const seenState = (): SeenState => ({
  transmittance: float(1).toVar(),
  distances: vec4(0).toVar(),
  shares: vec4(0).toVar(),
  index: float(0).toVar(),
  run: vec2(0).toVar(),
  most: float(0).toVar(),
  latest: float(0).toVar(),
  weightedDistance: float(0).toVar()
})

/** Goes on to a stratum, if the ray is not in it yet. */
function enterStratum({ index, run, most }: SeenState, next: Float): void {
  If(next.greaterThan(index), () => {
    index.assign(next)
    run.assign(vec2(0))
    most.assign(0)
  })
}

/** Ends a stratum where another cloud or layer begins: they may be lit apart, a high one in the sun when a low one is not. */
export function endStratum(state: SeenState): void {
  const { shares, index } = state
  const share = shares.dot(componentAt(index))
  const next = index.add(select(share.greaterThan(LEAST_SHARE), 1, 0)).min(POINTS - 1)
  enterStratum(state, next.toConst())
}

/** Optical depth below which a step's light comes from its middle [–]: what is taken off is less than a thousandth of its length. */
const THIN = 0.01

/**
 * Mean places that the light of steps comes from, relative to their middles [lengths of a step]: ∫ t e^{−τt} dt / ∫ e^{−τt} dt − ½ over t in
 * [0, 1]. Dense steps are seen at their beginning.
 *
 * @param depth - Their optical depths τ.
 */
function seenFromMiddle(depth: Vec2): Vec2 {
  const least = depth.max(THIN).toConst() as Vec2
  const through = least.negate().exp().toConst() as Vec2
  return least.reciprocal().sub(through.div(through.oneMinus())).sub(0.5).toConst()
}

/**
 * Adds two steps: energy-conserving integration, L += T S (1 − e^{−τ}) for steps of any length. The source S
 * is left open: one place of each stratum of opacity stands for it, the middle of the cloud that takes most
 * of it.
 *
 * @param depth - Scaled optical depths of both steps.
 * @param places - Distances of the middles of what of them is cloud [m].
 * @param lengths - Lengths of that [m].
 * @see Hillaire 2016, "Physically based sky, atmosphere and cloud rendering in Frostbite" §5.6.3
 */
export function addPair(
  state: SeenState,
  depth: Vec2,
  places: readonly Float[],
  lengths: Vec2
): void {
  const { transmittance, distances, shares, index, run, most, latest, weightedDistance } = state
  const through = depth.negate().exp().toConst() as Vec2
  const seen = vec2(
    transmittance.mul(through.x.oneMinus()),
    transmittance.mul(through.x).mul(through.y.oneMinus())
  ).toConst() as Vec2
  const both = seen.x.add(seen.y).toConst()
  const aside = seenFromMiddle(depth).mul(lengths).toConst()
  const weighted = places[0]
    .add(aside.x)
    .mul(seen.x)
    .add(places[1].add(aside.y).mul(seen.y))
    .toConst()
  const stratum = transmittance
    .oneMinus()
    .max(0)
    .sqrt()
    .mul(POINTS)
    .floor()
    .min(POINTS - 1)
  enterStratum(state, stratum.toConst())
  const gap = places[0].mul(GAP_GROWTH).max(LEAST_GAP)
  If(places[0].sub(latest).greaterThan(gap), () => {
    endStratum(state)
    run.assign(vec2(0))
  })
  run.addAssign(vec2(both, weighted))
  latest.assign(places[1])
  const own = componentAt(index)
  shares.addAssign(own.mul(both))
  // Clouds too thin to be seen have no share, and no middle.
  If(run.x.greaterThan(most), () => {
    most.assign(run.x)
    distances.assign(mix(distances, vec4(run.y.div(run.x)), own))
  })
  weightedDistance.addAssign(weighted)
  transmittance.mulAssign(through.x.mul(through.y))
}

/** Clouds on a ray that is done. */
export interface SeenClouds {
  readonly points: SeenPoints
  /** Share of the light behind that passes, in [0, 1]. */
  readonly transmittance: Float
  /** Mean distance of what is seen, by what each place contributes; of the first layer if nothing is [m]. */
  readonly distance: Float
}

/**
 * Clouds of a ray that is done. As good as opaque is opaque: nothing bright may shine through.
 *
 * @param nothing - Distance where it met nothing [m].
 */
export function seenClouds(state: SeenState, nothing: Float): SeenClouds {
  const { transmittance, distances, shares, weightedDistance } = state
  const opacity = transmittance.oneMinus().toConst()
  const passed = transmittance
    .sub(LEAST_TRANSMITTANCE)
    .max(0)
    .div(1 - LEAST_TRANSMITTANCE)
    .toConst() as Float
  const all = passed.oneMinus().div(opacity.max(1e-6)).toConst() as Float
  return {
    points: { distances, shares: shares.mul(all).toConst() },
    transmittance: passed,
    distance: select(
      opacity.greaterThan(1e-4),
      weightedDistance.div(opacity.max(1e-6)),
      nothing
    ).toConst()
  }
}
