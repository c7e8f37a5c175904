import { log2, vec2, vec3, vec4 } from 'three/tsl'
import type { Float, Vec2, Vec4 } from '../../tsl-types'

/** log₂ of the greatest distance that is told apart [m]. */
export const FARTHEST = 32

/** Distance [m] as render targets hold it: its log₂, in [0, `FARTHEST`]. */
export const encodeDistance = (distance: Float): Float => log2(distance.clamp(1, 2 ** FARTHEST))

/** Range of kept log₂ distances: 16 m, and 24 octaves on to 268,000 km. */
const FIRST_OCTAVE = 4
const OCTAVES = 24

/** log₂ distance, clamped to the range that {@link pack} keeps. */
export const clampDistance = (distance: Float): Float =>
  distance.clamp(FIRST_OCTAVE, FIRST_OCTAVE + OCTAVES)

/** Steps in which a sample count of 1 is stored: counts up to `FINE_SAMPLES` are good to 1/127, greater ones to 1/8. */
export const SAMPLE_STEPS = 127
const COARSE_STEPS = 8
const FINE_SAMPLES = 16
const COARSE_FROM = FINE_SAMPLES * SAMPLE_STEPS

/** Code of a sample count of 0 in 13 bits. */
const NO_SAMPLES = 2 ** 12

/** Steps of the clouds' distance: 11 bits, of which the lowest three are with the sample count. */
const DISTANCE_STEPS = 2 ** 11 - 1
const LOW_STEPS = 8

/**
 * History's distances and sample count as four bytes: log₂ of the clouds' distance in eleven bits, which is good to 0.4 % (an
 * eighth of a byte's steps: light shafts take away most of the light before it); log₂ of the end's in a byte, good to half
 * of `SAME_DISTANCE`; and the count in thirteen. Half of what half floats take.
 *
 * @param distance - log₂ of the clouds' distance.
 * @param end - log₂ of the distance of what was drawn.
 * @param samples - Accumulated samples, in [−256, 256]; negative where there is no cloud.
 * @param dither - In [0, 1): counts are rounded at random, right in the mean, for a clear pixel gains less than a step a frame.
 * @returns In [0, 1].
 */
export function pack(distance: Float, end: Float, samples: Float, dither: Float): Vec4 {
  const octaves = vec2(distance, end)
    .sub(FIRST_OCTAVE)
    .mul(1 / OCTAVES)
    .clamp()
    .toConst() as Vec2
  const steps = octaves.x.mul(DISTANCE_STEPS).round().toConst() as Float
  const high = steps
    .mul(1 / LOW_STEPS)
    .floor()
    .toConst() as Float
  const size = samples.abs().toConst() as Float
  const coarse = size.sub(FINE_SAMPLES).max(0).mul(COARSE_STEPS)
  const code = size
    .min(FINE_SAMPLES)
    .mul(SAMPLE_STEPS)
    .add(coarse)
    .add(dither)
    .floor()
    .mul(samples.sign())
  const bits = code.add(NO_SAMPLES).sub(high).mul(LOW_STEPS).add(steps).toConst() as Float
  const upper = bits
    .mul(1 / 256)
    .floor()
    .toConst() as Float
  const bytes = vec3(high, upper, bits.sub(upper.mul(256))).mul(1 / 255)
  return vec4(bytes.x, octaves.y, bytes.yz)
}

/** The inverse of {@link pack}: log₂ of both distances, and the sample count. */
export function unpack(bytes: Vec4): Vec4 {
  const whole = bytes.mul(255).round().toConst() as Vec4
  const bits = whole.z.mul(256).add(whole.w).toConst() as Float
  const count = bits
    .mul(1 / LOW_STEPS)
    .floor()
    .toConst() as Float
  const steps = whole.x.sub(count).mul(LOW_STEPS).add(bits)
  const code = count.sub(NO_SAMPLES).toConst() as Float
  const size = code.abs().toConst() as Float
  const coarse = size
    .sub(COARSE_FROM)
    .max(0)
    .mul(1 / COARSE_STEPS)
  const samples = size
    .min(COARSE_FROM)
    .mul(1 / SAMPLE_STEPS)
    .add(coarse)
    .mul(code.sign())
  const distance = steps.mul(OCTAVES / DISTANCE_STEPS).add(FIRST_OCTAVE)
  const end = whole.y.mul(OCTAVES / 255).add(FIRST_OCTAVE)
  return vec4(distance, end, samples, 0).toConst()
}
