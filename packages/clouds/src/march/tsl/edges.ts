import { If, float, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { Bool, Float, Variable, Vec2 } from '../../tsl-types'
import { NOT_SAMPLED } from '../../density/tsl/samplePair'

// Edges of clouds between samples. A step that meets a cloud begins anywhere before it: were all of it cloud, or half of it, pixels side by
// side would see edges nearer and farther by a step's length, which shows as grain where steps are long.

/** The last sample of a ray that was clear: its distance [m], and its strength, or `NOT_SAMPLED`. */
export type LastClear = Variable<Vec2>

/** Last clear sample of a ray that has met nothing yet. To be called inside of a shader function. */
export const lastClear = (): LastClear => vec2(0, NOT_SAMPLED).toVar()

/** Cloudy parts of two steps. */
export interface CloudySteps {
  /** Lengths of cloud [m]. */
  readonly lengths: Vec2
  /** Distances of their middles from the camera [m]. */
  readonly middles: readonly [Float, Float]
}

/**
 * Cloud before a sample, up to the one before it at most [m]: strength changes evenly from clear air to it, and cloud begins where it is 0. Half a
 * step, if it does not begin there.
 *
 * @param strength - Strength of the sample.
 * @param clear - Strength of the one before it.
 * @param gap - Distance between them [m].
 * @param length - Length of a step [m].
 */
function cloudBefore(strength: Float, clear: Float, gap: Float, length: Float): Float {
  const begins = strength
    .greaterThan(0)
    .and(clear.lessThan(0))
    .and(clear.greaterThan(NOT_SAMPLED / 2))
  const inside = strength.div(strength.sub(clear)).mul(gap).min(length)
  return select(begins, inside, length.mul(0.5))
}

/**
 * Cloudy parts of a pair of steps.
 *
 * @param places - Distances of both samples [m].
 * @param strength - Strengths of both.
 * @param length - Length of each step [m].
 */
export function cloudySteps(
  last: LastClear,
  places: readonly Float[],
  { x: first, y: second }: Vec2,
  length: Float
): CloudySteps {
  const inside = [
    cloudBefore(first, last.y, places[0].sub(last.x), length),
    cloudBefore(second, first, length, length)
  ].map(each => each.toConst() as Float)
  const behind = length.mul(0.5)
  const middleOf = (i: number): Float => places[i].add(behind.sub(inside[i]).mul(0.5)).toConst()
  return {
    lengths: vec2(inside[0], inside[1]).add(behind).toConst(),
    middles: [middleOf(0), middleOf(1)]
  }
}

/** Forgets the last clear sample, after a jump over air that was not sampled. */
export const forgetClear = (last: LastClear): void => {
  last.assign(vec2(0, NOT_SAMPLED))
}

/**
 * Keeps the last clear sample of a pair.
 *
 * @param isBack - True if the march went back from it, to its last clear sample.
 */
export function keepLastClear(
  last: LastClear,
  places: readonly Float[],
  { x: first, y: second }: Vec2,
  isBack: Bool
): void {
  If(isBack.not(), () => {
    last.assign(vec2(places[1], select(second.lessThan(0), second, float(NOT_SAMPLED))))
  }).ElseIf(first.lessThan(0), () => {
    last.assign(vec2(places[0], first))
  })
}
