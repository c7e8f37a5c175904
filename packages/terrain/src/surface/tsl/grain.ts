import { Fn, If, dFdx, dFdy, float, texture, vec2, vec3 } from 'three/tsl'
import type { Texture } from 'three'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { GRAIN_SLOPE, GRAIN_VALUE, GRAIN_WAVES } from '../grainTexture'

/** Sides of the picture on the ground: a part of the 256 m that references step by, so that it does not jump [m]. */
const COARSE_SIDE = 16

/** The finer one is turned by (3, 4)/5, and five times as small: whole numbers of sides in 256 m too. */
const TURN = [3, 4] as const
const FINE_GAIN = 0.3

/** Longer side of a pixel's footprint at which grain is gone, and the share of that in which it goes [m]. */
const GONE = 6
const FADE = 0.5

/** Place in a face's plane, and the face's axes. */
export interface GrainPlace {
  readonly grain: Texture
  /** Reference to the place [m]. */
  readonly offset: Vec3
  readonly first: Vec3
  readonly second: Vec3
}

type Variable = Vec3 & { assign(value: Vec3): void }

/** Gradient [1/m] and value of stones and tufts, from 2 m to 2 cm; 0 where they are smaller than pixels. */
export function grainAt({ grain, offset, first, second }: GrainPlace): {
  gradient: Vec3
  value: Float
} {
  const [c, s] = TURN
  const turned = ({ x, y }: Vec2): Vec2 => vec2(x.mul(c).add(y.mul(s)), y.mul(c).sub(x.mul(s)))
  const sum = Fn(() => {
    const at = vec2(offset.dot(first), offset.dot(second)).div(COARSE_SIDE).toConst() as Vec2
    // Sampled in a branch: most of a view is too far away.
    const across = dFdx(at).toConst() as Vec2
    const along = dFdy(at).toConst() as Vec2
    const footprint = across
      .length()
      .max(along.length())
      .mul(COARSE_SIDE / GONE)
    const kept = float(1).sub(footprint).div(FADE).min(1).toConst('kept')
    const total = vec3(0).toVar('grain') as unknown as Variable
    If(kept.greaterThan(0), () => {
      const sample = (place: Vec2, dx: Vec2, dy: Vec2): Vec3 => {
        const node = texture(grain, place) as unknown as {
          grad(dx: Vec2, dy: Vec2): { rgb: Vec3 }
        }
        return node.grad(dx, dy).rgb.mul(2).sub(1).toConst()
      }
      const coarse = sample(at, across, along)
      const fine = sample(turned(at), turned(across), turned(along))
      // The transposed matrix takes gradients back.
      const back = vec3(fine.x.mul(c).sub(fine.y.mul(s)), fine.x.mul(s).add(fine.y.mul(c)), fine.z)
      total.assign(coarse.add(back.mul(FINE_GAIN)).mul(kept))
    })
    return total
  })().toConst() as unknown as Vec3
  const slope = sum.xy.mul((GRAIN_SLOPE * GRAIN_WAVES) / COARSE_SIDE).toConst()
  return {
    gradient: first.mul(slope.x).add(second.mul(slope.y)),
    value: sum.z.mul(GRAIN_VALUE).toConst()
  }
}
