import { vec2 } from 'three/tsl'
import type { Float, Vec2 } from '../../tsl-types'

/**
 * A pattern of [0, 1) in which any 3×3 pixels are evenly spread.
 *
 * @see Jimenez 2014, "Next generation post processing in Call of Duty: Advanced Warfare",
 *   slide 123 (interleaved gradient noise)
 */
export function interleavedNoise(pixel: Vec2, shift: Float): Float {
  const across = pixel.dot(vec2(0.06711056, 0.00583715))
  return across.fract().mul(52.9829189).add(shift).fract().toConst()
}
