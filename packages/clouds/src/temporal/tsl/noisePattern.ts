import { hash, vec2 } from 'three/tsl'
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

/** Seeds from one row to the next: their greatest are whole numbers of a float still. */
const ROW = 4099

/** Spread of a number less the mean of four others, each uniform, that {@link blueNoise} makes uniform again: √3/π of the mean's deviation, 12^{−½}/2. */
const SMOOTHNESS = 0.0796

/**
 * Blue noise in [0, 1]: what is left of it in a picture is as fine as its pixels, and has neither rows nor a weave. White noise less the mean of its
 * four neighbours is high-pass, and nearly normal in that mean: its distribution function makes it uniform.
 *
 * @param pixel - Whole numbers.
 */
export function blueNoise(pixel: Vec2): Float {
  const seed = pixel.add(1).dot(vec2(1, ROW)).toConst() as Float
  const own = hash(seed)
  const around = [1, -1, ROW, -ROW].map(aside => hash(seed.add(aside)))
  const mean = around.reduce((sum, each) => sum.add(each)).mul(0.25)
  const high = own.sub(mean).div(SMOOTHNESS).toConst() as Float
  const half = 0.5 / SMOOTHNESS
  const ramp = high.add(half).exp().add(1).div(high.sub(half).exp().add(1))
  return ramp.log().mul(SMOOTHNESS).toConst()
}
