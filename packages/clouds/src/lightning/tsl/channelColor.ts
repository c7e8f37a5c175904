import { vec3 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'
import { CHANNEL_COLOR } from '../channel'

/** Place of 550 nm between 630 and 440 nm in λ⁻⁴: exponent of blue in green. */
const GREEN_SHARE = (550 ** -4 - 630 ** -4) / (440 ** -4 - 630 ** -4)

/**
 * Colour of a channel's light, linear sRGB, of what red and blue of it are over those of the channel itself: green lies between them as
 * λ⁻⁴ does, their mean by geometry.
 *
 * @param redBlue - ≥ 0, in any unit; 0 is black.
 */
export const channelColor = ({ x: red, y: blue }: Vec2): Vec3 =>
  vec3(red, red.pow(1 - GREEN_SHARE).mul(blue.pow(GREEN_SHARE)), blue).mul(vec3(...CHANNEL_COLOR))
