import { vec3 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'
import { CHANNEL_COLOR } from '../channel'

/**
 * Colour of a channel's light, linear sRGB, of what red and blue of it are over those of the channel itself: green lies between them as
 * λ⁻⁴ does of 544 nm between 630 and 440 nm, a quarter of the way, in their mean by geometry.
 *
 * @param redBlue - ≥ 0, in any unit; 0 is black.
 */
export const channelColor = ({ x, y }: Vec2): Vec3 =>
  vec3(x, x.mul(y).sqrt().mul(x).sqrt(), y).mul(vec3(...CHANNEL_COLOR))
