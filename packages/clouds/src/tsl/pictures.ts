import { log2 } from 'three/tsl'
import type { Float, LevelTexture, Vec2, Vec4 } from '../tsl-types'

/**
 * Pictures of clouds: light and transmittance; and log₂ of their distance, of the distance of what was
 * drawn, looks, steps.
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
