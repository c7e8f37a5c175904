import { float, vec3, vec4 } from 'three/tsl'
import { keptShare } from '../../noise/tsl/fractalSum'
import { latticeNoise } from '../../noise/tsl/latticeNoise'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import type { Warp } from '../cpu/mountains'

/** A place after a domain warp. */
export interface Warped {
  /** As of `latticeNoise`. */
  readonly offset: Vec3
  /** Displacement along each axis in units of `reach` (w), and its gradient (xyz) [1/m]. */
  readonly moves: readonly Vec4[]
  /** Gradient at the place itself from that at the warped one, with the value in w left as it is. */
  readonly back: (sum: Vec4) => Vec4
}

/** Displaces a place by noise (domain warping), unless the noise is too short to be seen. */
export function warped(
  { inverse, reach, seed: first }: Warp,
  reference: Vec3,
  offset: Vec3,
  shortest: Float,
  seed: Float
): Warped {
  const kept = keptShare(float(inverse), shortest).toConst()
  const moves = [0, 1, 2].map(axis => {
    const noise = latticeNoise(reference, offset, float(inverse), seed.add(first + axis)).toConst()
    return vec4(noise.xyz.mul(inverse), noise.w).mul(kept).toConst()
  }) as unknown as Vec4[]
  const [x, y, z] = moves
  return {
    offset: offset.add(vec3(x.w, y.w, z.w).mul(reach)).toConst(),
    moves,
    back: sum => {
      const turn = x.xyz.mul(sum.x).add(y.xyz.mul(sum.y)).add(z.xyz.mul(sum.z))
      return vec4(sum.xyz.add(turn.mul(reach)), sum.w).toConst()
    }
  }
}
