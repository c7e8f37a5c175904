import { vec3 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'
import { CHANNEL_COLOR } from '../channel'

/** Place of 550 nm between 630 and 440 nm in λ⁻⁴, (550⁻⁴ − 630⁻⁴) / (440⁻⁴ − 630⁻⁴): exponent of blue in green. */
const GREEN_SHARE = 0.2253

/**
 * Colour of a channel's light, linear sRGB, of what red and blue of it are over those of the channel itself: green lies between them as
 * λ⁻⁴ does, their mean by geometry.
 *
 * @param redBlue - ≥ 0, in any unit; 0 is black.
 */
export const channelColor = ({ x, y }: Vec2): Vec3 =>
  vec3(x, x.pow(1 - GREEN_SHARE).mul(y.pow(GREEN_SHARE)), y).mul(vec3(...CHANNEL_COLOR))
