import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** Outline of a streak: all that are within `outer` of its axis, full up to `inner`. */
export interface StreakShape {
  /** Radius up to which it is full [m]. */
  readonly inner: Float
  /** Radius at which it ends [m]. */
  readonly outer: Float
  /** Opacity inside, such that the streak takes as much light as the particle does [–]. */
  readonly opacity: Float
}

/** Radius at which a soft particle ends, over that of a disc that takes as much light: √(1/0.3), its middle is opaque. */
const SOFT_RADIUS = 1.83

/**
 * Streak of a round particle that moves while the shutter is open.
 *
 * Its edge is as wide as a pixel and the circle of confusion are. Opacity is the disc's π D²/4 over the integral of a profile
 * that falls from 1 to 0 by `smoothstep` between `inner` and `outer`, along the way and at both ends. Twin: test/twins/precipitation/meanDepth.ts
 *
 * @param width - Diameter D, > 0 [m].
 * @param length - Distance that its middle moves [m].
 * @param blur - Width of pixel and circle of confusion at its distance, > 0 [m].
 * @param isSoft - True for a particle that thins out from its middle on.
 */
export function streakShape(
  width: Float,
  length: Float,
  blur: Float,
  isSoft: boolean
): StreakShape {
  const half = width.mul(0.5).toConst() as Float
  const inner = (isSoft ? float(0) : half.sub(blur).max(0)).toConst() as Float
  const outer = half
    .mul(isSoft ? SOFT_RADIUS : 1)
    .add(blur)
    .toConst() as Float
  const edge = outer.sub(inner).toConst() as Float
  const ends = inner.mul(inner).add(inner.mul(edge)).add(edge.mul(edge).mul(0.3)).mul(Math.PI)
  const opacity = half
    .mul(half)
    .mul(Math.PI)
    .div(length.mul(inner.add(outer)).add(ends))
  return { inner, outer, opacity }
}
