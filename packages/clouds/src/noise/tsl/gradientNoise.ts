import {
  Fn,
  bitAnd,
  bitOr,
  cross,
  float,
  shiftLeft,
  shiftRight,
  uint,
  uvec3,
  vec3
} from 'three/tsl'
import { layout, loop, type Float, type Vec3 } from '../../tsl-types'
import { ONE, cellOf, digitsOf, fromBits, hashBits, hashCell, wrapped, type UInt } from './cellHash'

/** Weights of a cell's corner along each axis: `fade` where `offset` is 1, 1 − `fade` where it is 0. */
const cornerWeights = (offset: Vec3, fade: Vec3): Vec3 =>
  offset.mul(fade.mul(2).sub(1)).add(fade.oneMinus())

/** Quintic fade curve of Perlin noise. */
const fadeOf = (part: Vec3): Vec3 =>
  part
    .mul(part)
    .mul(part)
    .mul(part.mul(part.mul(6).sub(15)).add(10))

/**
 * Gradient noise of period 1 in each coordinate, about [−1, 1].
 *
 * @param p - Any place, in [−1, 2] for full precision.
 * @param cells - Cells in a period along each axis, whole.
 * @param seed - Whole, below 2¹⁶.
 * @see Perlin 2002, "Improving noise", SIGGRAPH, pp. 681–682, on the fade curve. Twin: test/twins/noise.ts
 */
export const perlin = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Vec3, Float]) => {
    const { base, part, origin, index } = cellOf(p, cells, seed)
    const stride = wrapped(base.add(1), cells).sub(origin).toConst()
    const fade = fadeOf(part).toConst()
    const sum = float(0).toVar()
    loop('corner', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const offset = vec3(digits).toConst()
      const gradient = hashCell(index.add(stride.mul(digits)))
        .mul(2)
        .sub(1)
      const weights = cornerWeights(offset, fade).toConst()
      const weight = weights.x.mul(weights.y).mul(weights.z)
      sum.addAssign(weight.mul(gradient.dot(part.sub(offset))))
    })
    return sum.mul(1.5)
  },
  layout('welkinPerlin', 'float', { p: 'vec3', cells: 'vec3', seed: 'float' })
) as unknown as (p: Vec3, cells: Vec3, seed: Float) => Float

/** Gradient from 30 of a hash's bits, ten for each component, in (−1, 1). */
const gradientOf = (bits: UInt): Vec3 => {
  const high = uvec3(
    shiftRight(bits as never, uint(9)),
    shiftLeft(bits as never, uint(1)),
    shiftLeft(bits as never, uint(11))
  )
  const mantissa = bitAnd(high as never, uvec3(0x7fe000) as never)
  return fromBits(bitOr(mantissa, uvec3(ONE) as never))
    .mul(2)
    .sub(3 - 1 / 1024)
}

/**
 * Curl of three Perlin potentials, which has no sinks and no sources: displacements by it neither
 * gather nor thin out what they move. Period 1; per cell. Parameters as of `perlin`.
 *
 * The potentials' gradients at a corner share a hash. With weights w, gradients a, b, c and heights
 * h = (a·d, b·d, c·d) of the corners, the potentials are Σ w h and their curl is Σ ∇w × h + w ∇ × h.
 *
 * @see Bridson et al. 2007, "Curl-noise for procedural fluid flow", §2. Twin: test/twins/noise.ts
 */
export const curl = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Float, Float]) => {
    const { base, part, origin, index } = cellOf(p, vec3(cells), seed)
    const stride = wrapped(base.add(1), vec3(cells)).sub(origin).toConst()
    const fade = fadeOf(part).toConst()
    const slope = part.mul(part.oneMinus()).mul(part.mul(part.oneMinus())).mul(30).toConst()
    const sum = vec3(0).toVar()
    loop('corner', 8, corner => {
      const digits = digitsOf(corner, 2).toConst()
      const offset = vec3(digits).toConst()
      const bits = hashBits(index.add(stride.mul(digits))).toConst()
      const a = gradientOf(bits.x).toConst()
      const b = gradientOf(bits.y).toConst()
      const c = gradientOf(bits.z).toConst()
      const fromCorner = part.sub(offset).toConst()
      const heights = vec3(a.dot(fromCorner), b.dot(fromCorner), c.dot(fromCorner))
      const weights = cornerWeights(offset, fade).toConst()
      const slopes = offset.mul(2).sub(1).mul(slope).toConst()
      const gradient = slopes.mul(weights.yzx).mul(weights.zxy)
      const turning = vec3(c.y.sub(b.z), a.z.sub(c.x), b.x.sub(a.y))
      sum.addAssign(cross(gradient, heights))
      sum.addAssign(turning.mul(weights.x.mul(weights.y).mul(weights.z)))
    })
    return sum
  },
  layout('welkinCurl', 'vec3', { p: 'vec3', cells: 'float', seed: 'float' })
) as unknown as (p: Vec3, cells: Float, seed: Float) => Vec3
