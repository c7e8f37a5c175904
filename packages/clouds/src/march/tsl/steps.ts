import { If, bool, float } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { QualityUniforms } from '../quality'
import type { Bool, Float, Variable, Vec2 } from '../../tsl-types'
import { CAUTION } from '../../density/tsl/likelyDistance'

// The step policy of the march, and nothing else: a pair of samples lies half a step and one and a half
// steps ahead. Through clear air steps are as long as there is likely no cloud; a pair that lands in one goes
// back, and then steps are parts of the mean free path. It may depend on the distance, the segment between
// two layer boundaries, the quality, noise, what the pair before found, and the transmittance up to it; never
// on the light.

/** Least number of steps through a layer that is thinner than a few samples are wide. Fewer: grain in far cirrus (*Cirrus*). */
const LEAST_STEPS = 4

/**
 * Steps through clear air over those in clouds that grow with the distance, at most. Less: rays along the
 * horizon run out of steps, and clouds end there (*Cumulus from the ground*).
 */
const CLEAR_GROWTH = 4

/**
 * Likely distance to cloud below which steps are as short as in clouds, and how they grow beyond it with what is left of it [steps in clouds].
 * Steps that grow at once: edges of low clouds are ragged (*Cumulus*).
 */
const NEAR = 0.25
const GRADUAL = 0.75

/**
 * Steps through clear air near storms over those in clouds that grow with the distance. Greater: heads, which are smaller than that
 * from afar, are missed by whole rows of pixels, as dashes in towers 30 km away (*Storm*). Smaller: slower.
 */
const NEAR_GROWTH = 1.5

/**
 * Steps through clear air longer than this many in clouds go back where they find one; less than `NEAR_GROWTH`. Greater:
 * near edges are ragged (*Inside a cloud*), and towers have contours, since rays side by side meet them in step (*Storm*).
 */
const LOOK_BACK = 1.2

/**
 * Steps in clouds of which nothing more is seen, over those at their edges, less 1. Greater: faster, and the
 * insides of thin clouds get coarse, also while one turns (*Cirrus*).
 */
const HIDDEN_GROWTH = 2

/**
 * Part of the likely distance by which steps through clear air are shorter by chance: or else rays side by side end up in step, and
 * miss the same heads. 0: contours in towers (*Storm*); greater: slower, and pictures of small clouds do not come to rest.
 */
const SPREAD = 0.1

/** Least part that the first pair in clouds is cut to, by chance: from there up to 1, its two samples sweep one step. */
const LEAST_PART = 0.5

/** State of the step policy. */
export interface StepState {
  /** True among clouds: steps are parts of the mean free path. */
  readonly isFine: Variable<Bool>
  /** Length of steps in clouds as dense as they are at this height, and of any step at most [m]. */
  readonly finest: Variable<Float>
  readonly longest: Variable<Float>
  /** Likely distance to cloud that the pair before found [m]. */
  readonly likely: Variable<Float>
  /** True where the pair before was near a storm. */
  readonly isNear: Variable<Bool>
  /** Length of a step of the pair before [m]: its second half step was not sampled. */
  readonly before: Variable<Float>
  /** Part of the next pair's length: the first of a row is cut short, by chance, so that no layers show. */
  readonly part: Variable<Float>
  /** Noise in [0, 1), another for each pair: the part to start rows with, and by which steps in clear air are cut short. */
  readonly jitter: Variable<Float>
  /** True if steps in clear air are cut short by chance. */
  readonly isVaried: boolean
}

/** Two steps of the same length. */
export interface StepPair {
  /** Length of each [m]. */
  readonly length: Float
  /** Length of a step in clouds at this distance [m]. */
  readonly fine: Float
}

/**
 * Steps before the first segment.
 *
 * @param isVaried - True for steps through clear air of lengths by chance: see {@link SPREAD}.
 */
export const stepState = (jitter: Float, isVaried: boolean): StepState => ({
  isFine: bool(false).toVar(),
  finest: float(0).toVar(),
  longest: float(0).toVar(),
  likely: float(0).toVar(),
  isNear: bool(false).toVar(),
  before: float(0).toVar(),
  part: float(0).toVar(),
  jitter: jitter.toVar(),
  isVaried
})

/**
 * Sets the steps of a segment between two layer boundaries.
 *
 * @param density - Greatest extinction of a layer on it, as it counts in the light that comes through [1/m].
 * @param from - Distance from the camera [m].
 * @param to - Distance of its end [m].
 */
export function enterSteps(
  { isFine, finest, longest, likely, before, part, jitter }: StepState,
  field: CloudField,
  quality: QualityUniforms,
  density: Float,
  from: Float,
  to: Float
): void {
  isFine.assign(false)
  likely.assign(0)
  before.assign(0)
  part.assign(jitter)
  const span = to.sub(from).toConst()
  const footprint = from.mul(field.pixelAngle)
  longest.assign(
    span
      .div(quality.layerSteps)
      .max(footprint.min(span.div(LEAST_STEPS)))
      .max(1)
  )
  finest.assign(stepIn(quality, density, longest))
}

/** Length of steps in clouds of an extinction, as it counts in the light that comes through [m]. */
const stepIn = (quality: QualityUniforms, density: Float, longest: Float): Float =>
  quality.depthStep.div(density.max(1e-6)).max(quality.shortestStep).min(longest)

/**
 * The next two steps: they grow with the distance and with what hides them, and end at the end of the segment.
 *
 * @param transmittance - Share of the light from there that reaches the camera, in [0, 1].
 */
export function nextSteps(
  { isFine, finest, longest, likely, isNear, part, jitter, isVaried }: StepState,
  stepGrowth: Float,
  position: Float,
  end: Float,
  transmittance: Float
): StepPair {
  const growing = position.mul(stepGrowth).toConst() as Float
  const fine = finest.max(growing).min(longest).toConst() as Float
  const gradual = likely
    .div(fine)
    .mul(GRADUAL)
    .add(1 - NEAR * GRADUAL)
  const growth = gradual.min(select(isNear, NEAR_GROWTH, CLEAR_GROWTH))
  const least = fine.max(growing.mul(growth)).min(longest).toConst() as Float
  if (isVaried) jitter.assign(jitter.add(0.618034).fract())
  const caution = isVaried ? jitter.mul(SPREAD).add(CAUTION - SPREAD) : CAUTION
  const clear = likely.mul(caution).clamp(least, longest)
  const left = end.sub(position).mul(0.5)
  const hidden = transmittance.oneMinus().mul(HIDDEN_GROWTH).add(1)
  const whole = select(isFine, fine.mul(hidden).min(longest), clear) as Float
  const length = whole.mul(part.max(0.1)).min(left).max(0.01).toConst() as Float
  part.assign(1)
  return { length, fine }
}

/** Clouds that a pair of samples found: see `SamplePair`. */
export interface FoundClouds {
  /** Extinction of both samples [1/m]. */
  readonly extinction: Vec2
  readonly likelyDistance: Float
  readonly isNear: Bool
  /** Greatest extinction there, as it counts in the light that comes through; 0 if nothing was sampled [1/m]. */
  readonly greatest: Float
}

/**
 * Goes on from a pair: forward, or back to where it began if it jumped into a cloud.
 *
 * @param accept - Adds the pair's light, where it counts.
 * @returns Advance of the position [m].
 */
export function advance(
  { isFine, finest, longest, likely, isNear, before, part, jitter }: StepState,
  { length, fine }: StepPair,
  quality: QualityUniforms,
  { extinction, likelyDistance, isNear: near, greatest }: FoundClouds,
  accept: () => void
): Float {
  const forward = length.mul(2).toVar() as Variable<Float>
  const isCloudy = extinction.x.max(extinction.y).greaterThan(0).toConst()
  If(isCloudy.and(isFine.not()).and(length.greaterThan(fine.mul(LOOK_BACK))), () => {
    // Back to the last sample that was clear.
    forward.assign(select(extinction.x.greaterThan(0), before.mul(-0.5), length.mul(0.5)))
    isFine.assign(true)
    part.assign(jitter.max(LEAST_PART))
  }).Else(() => {
    const isNext = isCloudy.or(likelyDistance.lessThan(fine.mul(NEAR))).toConst()
    part.assign(select(isNext.and(isFine.not()), jitter.max(LEAST_PART), 1))
    isFine.assign(isNext)
    // Where all layers are known to be clear, none was sampled: steps as long as in thin air would jump over towers.
    finest.assign(select(greatest.greaterThan(0), stepIn(quality, greatest, longest), finest))
    likely.assign(likelyDistance)
    isNear.assign(near)
    before.assign(length)
    If(isCloudy, accept)
  })
  return forward
}
