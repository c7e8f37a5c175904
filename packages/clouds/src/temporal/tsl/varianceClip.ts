import { If, mix, vec2 } from 'three/tsl'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import { brightness } from './renderTargets'

/** Neighbourhood of a pixel among this frame's marched pixels. */
export interface Neighbourhood {
  /** Mean light and transmittance; reads a texture where it is called. */
  readonly mean: () => Vec4
  /** Means of brightness and transmittance, and their standard deviations. */
  readonly statistics: Vec4
}

/**
 * Variance clip of history: light is moved straight towards the neighbourhood's mean until its brightness
 * and its transmittance are within `deviations` standard deviations, plus `slack`, of that mean.
 *
 * @param deviations - Half width of the box in standard deviations, γ of the paper.
 * @param slack - Extra tolerance in units of brightness and of transmittance.
 * @see Yang et al. 2020, "A survey of temporal antialiasing techniques", §4.2, after Salvi 2016 (variance clipping) and
 *   Karis 2014 (clipping towards the mean)
 */
export function varianceClip(
  light: Vec4,
  { mean, statistics }: Neighbourhood,
  deviations: Float,
  slack: Float
): Vec4 {
  const clipped = light.toVar() as Vec4
  const difference = vec2(brightness(light), light.w).sub(statistics.xy).abs()
  const excess = difference.div(statistics.zw.mul(deviations).add(slack)).toConst() as Vec2
  const most = excess.x.max(excess.y).toConst() as Float
  If(most.greaterThan(1), () => {
    clipped.assign(mix(mean(), light, most.reciprocal()))
  })
  return clipped
}
