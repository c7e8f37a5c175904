import { log2, vec2, vec4 } from 'three/tsl'
import type { Float, LevelTexture, Vec2, Vec4 } from '../../tsl-types'

/**
 * Pictures of clouds: light and transmittance; and log₂ of their distance, of the distance of what was
 * drawn, looks, steps. What is remembered has the latter as bytes: see {@link pack}.
 */
export interface CloudPictures {
  readonly light: LevelTexture<Vec2>
  readonly place: LevelTexture<Vec2>
}

/** log₂ of the greatest distance that is told apart [m]. */
export const FARTHEST = 32

/** Transmittance above which there is no cloud. */
export const CLEAR = 0.999

/** log₂ of distances that are taken as the same thing. */
export const SAME = 0.1

/** Distance as it is stored. */
export const encodeDistance = (distance: Float): Float => log2(distance.clamp(1, 2 ** FARTHEST))

/** Whether clouds at a place are those that a pixel would see that ends elsewhere. */
export function fits(end: Float, { x: distance, y: otherEnd }: Vec4): Float {
  const areBeyond = end.min(otherEnd).greaterThan(distance)
  const isSame = end.sub(otherEnd).abs().lessThan(SAME)
  return areBeyond.or(isSame).select(1, 0)
}

/** Brightness that differences of colour are told by. */
export const brightness = ({ x, y, z }: Vec4): Float => x.add(y.mul(2)).add(z).mul(0.25)

/** log₂ of the distances that bytes hold, from the first on, and how many octaves [m]. */
const FIRST_OCTAVE = 4
const OCTAVES = 24

/** log₂ of a distance as far as bytes know it. */
export const known = (distance: Float): Float =>
  distance.clamp(FIRST_OCTAVE, FIRST_OCTAVE + OCTAVES)

/** Parts of a look that are told apart, and what no looks are in 16 bits. */
export const LOOK_PARTS = 127
const NO_LOOKS = 2 ** 15

/**
 * log₂ of two distances in a byte each, good to half of `SAME`, and looks in two, in [0, 1]: half of what
 * half floats take.
 *
 * @param looks - In [−256, 256].
 */
export function pack(distance: Float, end: Float, looks: Float): Vec4 {
  const bits = looks.mul(LOOK_PARTS).round().add(NO_LOOKS).toConst() as Float
  const high = bits.div(256).floor().toConst() as Float
  const [first, second] = [distance, end].map(at => at.sub(FIRST_OCTAVE).div(OCTAVES))
  return vec4(first, second, vec2(high, bits.sub(high.mul(256))).div(255))
}

/** What {@link pack} has packed: log₂ of both distances, and looks. */
export function unpack(bytes: Vec4): Vec4 {
  const distances = bytes.xy.mul(OCTAVES).add(FIRST_OCTAVE)
  const looks = bytes.zw.mul(255).round().dot(vec2(256, 1)).sub(NO_LOOKS).div(LOOK_PARTS)
  return vec4(distances, looks, 0).toConst()
}
