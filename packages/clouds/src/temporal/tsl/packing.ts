import { log2, vec2, vec4 } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'

/** log₂ of the greatest distance that is told apart [m]. */
export const FARTHEST = 32

/** Distance [m] as render targets hold it: its log₂, in [0, `FARTHEST`]. */
export const encodeDistance = (distance: Float): Float => log2(distance.clamp(1, 2 ** FARTHEST))

/** Range of a byte's log₂ distances: 16 m, and 24 octaves on to 268,000 km. */
const FIRST_OCTAVE = 4
const OCTAVES = 24

/** Step in which log₂ distances are kept. */
export const DISTANCE_STEP = OCTAVES / 255

/** log₂ distance, clamped to the range that {@link pack} keeps. */
export const clampDistance = (distance: Float): Float =>
  distance.clamp(FIRST_OCTAVE, FIRST_OCTAVE + OCTAVES)

/** Steps in which a sample count of 1 is stored: counts are good to 1/127. */
export const SAMPLE_STEPS = 127

/** Code of a sample count of 0 in 16 bits. */
const NO_SAMPLES = 2 ** 15

/**
 * History's distances and sample count as four bytes: log₂ of two distances in a byte each, good to half
 * of `SAME_DISTANCE`, and the count in two. Half of what half floats take.
 *
 * @param distance - log₂ of the clouds' distance.
 * @param end - log₂ of the distance of what was drawn.
 * @param samples - Accumulated samples, in [−256, 256]; negative where there is no cloud.
 * @returns In [0, 1].
 */
export function pack(distance: Float, end: Float, samples: Float): Vec4 {
  const bits = samples.mul(SAMPLE_STEPS).round().add(NO_SAMPLES).toConst() as Float
  const high = bits
    .mul(1 / 256)
    .floor()
    .toConst() as Float
  const octaves = vec2(distance, end)
    .sub(FIRST_OCTAVE)
    .mul(1 / OCTAVES)
  return vec4(octaves, vec2(high, bits.sub(high.mul(256))).mul(1 / 255))
}

/** The inverse of {@link pack}: log₂ of both distances, and the sample count. */
export function unpack(bytes: Vec4): Vec4 {
  const distances = bytes.xy.mul(OCTAVES).add(FIRST_OCTAVE)
  const bits = bytes.zw.mul(255).round().dot(vec2(256, 1))
  const samples = bits.sub(NO_SAMPLES).mul(1 / SAMPLE_STEPS)
  return vec4(distances, samples, 0).toConst()
}
