import { texture, vec2 } from 'three/tsl'
import type { Texture } from 'three'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { GRAIN_SLOPE, GRAIN_VALUE, GRAIN_WAVES } from '../grainTexture'

/** Sides of the picture on the ground: a part of the 256 m that references step by, so that it does not jump [m]. */
const COARSE_SIDE = 16

/** The finer one is turned by (3, 4)/5, and five times as small: whole numbers of sides in 256 m too. */
const TURN = [3, 4] as const
const FINE_GAIN = 0.3

/** Place in a face's plane, and the face's axes. */
export interface GrainPlace {
  readonly grain: Texture
  /** Reference to the place [m]. */
  readonly offset: Vec3
  readonly first: Vec3
  readonly second: Vec3
}

/** Gradient [1/m] and value of stones and tufts, from 2 m to 2 cm; about 0 where they are smaller than pixels. */
export function grainAt({ grain, offset, first, second }: GrainPlace): {
  gradient: Vec3
  value: Float
} {
  const sample = (at: Vec2): Vec3 => {
    const node = texture(grain, at) as unknown as { rgb: Vec3 }
    return node.rgb
      .mul(255 / 127.5)
      .sub(1)
      .toConst()
  }
  const at = vec2(offset.dot(first), offset.dot(second)).div(COARSE_SIDE).toConst()
  const [c, s] = TURN
  const coarse = sample(at)
  const fine = sample(vec2(at.x.mul(c).add(at.y.mul(s)), at.y.mul(c).sub(at.x.mul(s))))
  // The transposed matrix takes gradients back.
  const back = vec2(fine.x.mul(c).sub(fine.y.mul(s)), fine.x.mul(s).add(fine.y.mul(c)))
  const slope = coarse.xy
    .add(back.mul(FINE_GAIN))
    .mul((GRAIN_SLOPE * GRAIN_WAVES) / COARSE_SIDE)
    .toConst()
  return {
    gradient: first.mul(slope.x).add(second.mul(slope.y)),
    value: coarse.z.add(fine.z.mul(FINE_GAIN)).mul(GRAIN_VALUE).toConst()
  }
}
