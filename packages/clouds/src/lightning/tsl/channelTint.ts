import { vec3 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'

/** Place of 550 nm between 630 and 440 nm in λ⁻⁴, (550⁻⁴ − 630⁻⁴) / (440⁻⁴ − 630⁻⁴): exponent of blue in green. */
const GREEN_SHARE = 0.2253

/**
 * Light over the channel's colour in red, green and blue, from that in red and blue: green lies between them as λ⁻⁴ does, their mean by
 * geometry.
 *
 * @param redBlue - ≥ 0, in any unit; 0 is black.
 */
export const channelTint = ({ x, y }: Vec2): Vec3 =>
  vec3(x, x.pow(1 - GREEN_SHARE).mul(y.pow(GREEN_SHARE)), y)
