import { float } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { QualityUniforms } from '../quality'
import type { Float } from '../../tsl-types'
import { FAR_AWAY } from './layerBoundaries'

// The step policy of the march, and nothing else: a pair of samples goes half a step and one and a half
// steps ahead. It may depend on the distance, the segment between two layer boundaries, the quality, noise,
// and what the pair before found; never on what is seen of the light.

/** Least number of steps through a layer that is thinner than a few samples are wide. */
const LEAST_STEPS = 4

/**
 * Vertical optical depth of a layer below which it takes fewer steps, and the least part of them. What is
 * thin all the way through has no hard edges: greater, and *Cirrus* costs more; smaller, and it has bands.
 */
const THIN = 4
const LEAST_EFFORT = 0.35

/** Where a march is in its steps. */
export interface StepState {
  /** Length of a step per distance from the camera [–]. */
  readonly growth: FloatVariable
  /** Longest step on the segment [m]. */
  readonly longest: FloatVariable
  /** Part of the next pair's length: the first of a row is cut short, by chance, so that no layers show. */
  readonly part: FloatVariable
  /** Noise in [0, 1), the part to start rows with. */
  readonly jitter: Float
}

/** A variable of a shader. */
type FloatVariable = Float & { assign: (n: Float | number) => void }

/** Two steps of the same length. */
export interface StepPair {
  /** Length of each, shortened [m]. */
  readonly length: Float
  /** Length of a step that is not cut short [m]. */
  readonly whole: Float
  /** Distance to the end of the segment [m]. */
  readonly left: Float
}

/** Steps before the first segment. */
export const stepState = (jitter: Float): StepState => ({
  growth: float(0).toVar(),
  longest: float(FAR_AWAY).toVar(),
  part: jitter.toVar(),
  jitter
})

/**
 * Sets the steps of a segment between two layer boundaries.
 *
 * @param depth - Greatest vertical optical depth of a layer on it.
 * @param from - Distance from the camera [m].
 * @param to - The same of its end [m].
 */
export function enterSteps(
  { growth, longest, part, jitter }: StepState,
  field: CloudField,
  quality: QualityUniforms,
  depth: Float,
  from: Float,
  to: Float
): void {
  const effort = depth.div(THIN).clamp(LEAST_EFFORT, 1).toConst() as Float
  part.assign(jitter)
  growth.assign(quality.stepGrowth.div(effort))
  const span = to.sub(from).toConst()
  const footprint = from.mul(field.pixelAngle)
  longest.assign(
    span
      .div(quality.layerSteps.mul(effort).max(LEAST_STEPS))
      .max(footprint.min(span.div(LEAST_STEPS)))
      .max(1)
  )
}

/** The next two steps: they grow with the distance, and end at the end of the segment. */
export function nextSteps(
  { growth, longest, part }: StepState,
  quality: QualityUniforms,
  position: Float,
  end: Float
): StepPair {
  const growing = position.mul(growth).max(quality.shortestStep)
  const left = end.sub(position).toConst() as Float
  const whole = growing.min(longest).toConst() as Float
  const length = whole.mul(part).min(left.mul(0.5)).max(0.01).toConst() as Float
  part.assign(1)
  return { length, whole, left }
}

/**
 * Advance from a pair in clear air: as far as there is no cloud for sure. A new row of steps begins where
 * that is farther than the steps are long [m].
 *
 * @param emptyDistance - From the second of the pair's samples [m].
 */
export function advanceInClear(
  { part, jitter }: StepState,
  { length, whole, left }: StepPair,
  emptyDistance: Float
): Float {
  const clear = length.mul(1.5).add(emptyDistance).toConst() as Float
  part.assign(clear.greaterThan(whole.mul(2)).select(jitter, 1))
  return length.mul(2).max(clear.min(left))
}
