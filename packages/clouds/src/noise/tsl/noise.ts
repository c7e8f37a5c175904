import {
  Fn,
  If,
  bitAnd,
  bitOr,
  bitXor,
  cross,
  float,
  floor,
  shiftLeft,
  shiftRight,
  step,
  uint,
  uintBitsToFloat,
  uvec3,
  vec3
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layout, loop, type Float, type Int, type Vec3 } from '../../tsl-types'

type UInt = Node<'uint'>
type UVec3 = Node<'uvec3'>

/**
 * 96 bits for a cell of a lattice.
 *
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", on PCG3D. Twin: test/twins/noise.ts
 */
export const hashBits = /*#__PURE__*/ Fn(
  ([cell]: [UVec3]) => {
    const v = cell.mul(uint(1664525)).add(uint(1013904223)).toVar() as never as Record<
      'x' | 'y' | 'z',
      UInt & { addAssign: (n: Node) => void; assign: (n: Node) => void }
    >
    const mix = (): void => {
      v.x.addAssign(v.y.mul(v.z))
      v.y.addAssign(v.z.mul(v.x))
      v.z.addAssign(v.x.mul(v.y))
    }
    mix()
    for (const axis of ['x', 'y', 'z'] as const) {
      v[axis].assign(bitXor(v[axis] as never, shiftRight(v[axis] as never, uint(16))))
    }
    mix()
    return uvec3(v.x, v.y, v.z)
  },
  layout('welkinHashBits', 'uvec3', { cell: 'uvec3' })
) as unknown as (cell: UVec3) => UVec3

/** Bits of numbers in [1, 2). */
const ONE = 0x3f800000

const fromBits = (bits: Node): Vec3 => uintBitsToFloat(bits) as unknown as Vec3

/** Three numbers in [0, 1) for a cell of a lattice, each a multiple of 2⁻²³: exact in float32. */
export const hashCell = /*#__PURE__*/ Fn(
  ([cell]: [UVec3]) => {
    // Set as the bits of floats: to convert integers is slow on many GPUs.
    const mantissa = shiftRight(hashBits(cell) as never, uvec3(9) as never)
    return fromBits(bitOr(mantissa, uvec3(ONE) as never)).sub(1)
  },
  layout('welkinHashCell', 'vec3', { cell: 'uvec3' })
) as unknown as (cell: UVec3) => Vec3

/** Index of a cell in a lattice that repeats after `cells`. `corner` is whole. */
const wrapped = (corner: Vec3, cells: Vec3): UVec3 => {
  // + ½: the division is not exact on every GPU.
  const periods = floor(corner.add(0.5).div(cells))
  return uvec3(corner.sub(periods.mul(cells)).add(0.5))
}

/** A place's cell, with its index for `hashBits`. */
const cellOf = (
  p: Vec3,
  cells: Vec3,
  seed: Float
): { base: Vec3; part: Vec3; origin: UVec3; index: UVec3 } => {
  const base = p.mul(cells).floor().toConst('base')
  const part = p.mul(cells).sub(base).toConst('part')
  const origin = wrapped(base, cells).toConst('origin')
  const index = origin.add(uvec3(0, 0, uint(seed.add(0.5)))).toConst('index')
  return { base, part, origin, index }
}

/** Digits of a number below base³: one for each coordinate. */
const digitsOf = (number: Int, base: number): UVec3 => {
  const n = uint(number)
  return uvec3(n.mod(uint(base)), n.div(uint(base)).mod(uint(base)), n.div(uint(base * base)))
}

/** Weights of a corner along each axis, from those of the corner beyond. */
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
 * @see Perlin 2002, "Improving noise", on the fade curve. Twin: test/twins/noise.ts
 */
export const perlin = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Vec3, Float]) => {
    const { base, part, origin, index } = cellOf(p, cells, seed)
    const stride = wrapped(base.add(1), cells).sub(origin).toConst('stride')
    const fade = fadeOf(part).toConst('fade')
    const sum = float(0).toVar('sum')
    loop('corner', 8, corner => {
      const digits = digitsOf(corner, 2).toConst('digits')
      const offset = vec3(digits).toConst('offset')
      const gradient = hashCell(index.add(stride.mul(digits)))
        .mul(2)
        .sub(1)
      const weights = cornerWeights(offset, fade).toConst('weights')
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
 * @see Bridson et al. 2007, "Curl-noise for procedural fluid flow". Twin: test/twins/noise.ts
 */
export const curl = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Float, Float]) => {
    const { base, part, origin, index } = cellOf(p, vec3(cells), seed)
    const stride = wrapped(base.add(1), vec3(cells)).sub(origin).toConst('stride')
    const fade = fadeOf(part).toConst('fade')
    const slope = part.mul(part.oneMinus()).mul(part.mul(part.oneMinus())).mul(30).toConst('slope')
    const sum = vec3(0).toVar('sum')
    loop('corner', 8, corner => {
      const digits = digitsOf(corner, 2).toConst('digits')
      const offset = vec3(digits).toConst('offset')
      const bits = hashBits(index.add(stride.mul(digits))).toConst('bits')
      const a = gradientOf(bits.x).toConst('a')
      const b = gradientOf(bits.y).toConst('b')
      const c = gradientOf(bits.z).toConst('c')
      const way = part.sub(offset).toConst('way')
      const heights = vec3(a.dot(way), b.dot(way), c.dot(way))
      const weights = cornerWeights(offset, fade).toConst('weights')
      const slopes = offset.mul(2).sub(1).mul(slope).toConst('slopes')
      const gradient = slopes.mul(weights.yzx).mul(weights.zxy)
      const turning = vec3(c.y.sub(b.z), a.z.sub(c.x), b.x.sub(a.y))
      sum.addAssign(cross(gradient, heights))
      sum.addAssign(turning.mul(weights.x.mul(weights.y).mul(weights.z)))
    })
    return sum
  },
  layout('welkinCurl', 'vec3', { p: 'vec3', cells: 'float', seed: 'float' })
) as unknown as (p: Vec3, cells: Float, seed: Float) => Vec3

/**
 * 1 − F₁, with F₁ the distance to the nearest of the points scattered one in each cell: round bulges
 * that meet in sharp creases, as on cauliflowers. Period 1, in [0, 1]. Parameters as of `perlin`.
 *
 * The eight nearest cells are visited first, then others, unless they lie beyond the nearest point so
 * far: 9.3 of 27 on average.
 *
 * @see Worley 1996, "A cellular texture basis function", on F₁. Twin: test/twins/noise.ts
 */
export const billow = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Vec3, Float]) => {
    const { base, part, origin, index } = cellOf(p, cells, seed)
    // Towards the nearer neighbour along each axis.
    const side = step(vec3(0.5), part).mul(2).sub(1).toConst('side')
    const nearStep = wrapped(base.add(side), cells).sub(origin).toConst('nearStep')
    const farStep = wrapped(base.sub(side), cells).sub(origin).toConst('farStep')
    const nearest = float(1).toVar('nearest')
    const visit = (cell: UVec3, offset: Vec3): void => {
      const gap = offset.add(hashCell(cell)).sub(part).toConst()
      nearest.assign(nearest.min(gap.dot(gap)))
    }
    loop('nearCell', 8, corner => {
      const digits = digitsOf(corner, 2).toConst('nearDigits')
      visit(index.add(nearStep.mul(digits)), side.mul(vec3(digits)))
    })
    // Squared distances to the cells beside this one.
    const nearGap = part.min(part.oneMinus()).toConst('nearGap')
    const farGap = part.max(part.oneMinus()).toConst('farGap')
    const nearSquare = nearGap.mul(nearGap).toConst('nearSquare')
    const farSquare = farGap.mul(farGap).toConst('farSquare')
    If(farSquare.x.min(farSquare.y).min(farSquare.z).lessThan(nearest), () => {
      loop('farCell', 27, neighbour => {
        // Digits 0, 1 and 2: this cell's row, the nearer one's, the farther one's.
        const digits = digitsOf(neighbour, 3).toConst('digits')
        const isNear = bitAnd(digits as never, uvec3(1) as never) as unknown as UVec3
        const isFar = shiftRight(digits as never, uvec3(1) as never) as unknown as UVec3
        const near = vec3(isNear).toConst('near')
        const far = vec3(isFar).toConst('far')
        const beyond = nearSquare.dot(near).add(farSquare.dot(far))
        const isBeside = far.x.max(far.y).max(far.z).greaterThan(0)
        If(isBeside.and(beyond.lessThan(nearest)), () => {
          const cell = index.add(nearStep.mul(isNear)).add(farStep.mul(isFar))
          visit(cell, side.mul(near.sub(far)))
        })
      })
    })
    return nearest.sqrt().oneMinus()
  },
  layout('welkinBillow', 'float', { p: 'vec3', cells: 'vec3', seed: 'float' })
) as unknown as (p: Vec3, cells: Vec3, seed: Float) => Float
