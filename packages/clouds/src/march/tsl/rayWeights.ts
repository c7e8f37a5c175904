import { mix, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { Float, Vec2 } from '../../tsl-types'

/** Weight of the nearest of three rays in a row that pixels share. 1: noise of single rays is seen as a weave, as wide as blocks (*Rain and snow*). */
const OWN_WEIGHT = 0.5

/**
 * Weights of a shared ray and of those beside it for a pixel, along either axis. Neighbouring rays are averaged in pairs, and pixels take what lies between two
 * pairs. The noise of rays is even over 3 × 3 of them: a tenth to three fifths is left of what bilinear weights leave. Twin: test/twins/rayWeights.ts
 *
 * @param past - Place of the pixel past the nearest ray, in [−0.5, 0.5] [rays].
 * @param step - Place of the other ray past the nearest: −1, 0 or 1 [rays].
 * @param fallBlock - Pixels along an edge of those that share a ray. For 1 each has its own ray, and takes it as it is.
 */
export function rayWeights(past: Vec2, step: Vec2, fallBlock: Float): Vec2 {
  const own = select(fallBlock.greaterThan(1), OWN_WEIGHT, 1).toConst() as Float
  const beside = step.mul(past).sub(own).add(1).mul(0.5)
  return mix(vec2(own), beside, step.abs()).toConst()
}
