import {
  Fn,
  bitOr,
  bitXor,
  ivec3,
  shiftRight,
  uint,
  uintBitsToFloat,
  uvec3,
  vec3,
  vec4
} from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layout, type Float, type UInt, type UVec3, type Vec3, type Vec4 } from '../../tsl-types'

/** Length that a reference point is a whole multiple of [m]. */
export const REFERENCE_STEP = 256

/** Bits of the number 1, with which those of all numbers in [1, 2) begin. */
const ONE = 0x3f800000

type Triple = [number, number, number]

type UVariable = Record<'x' | 'y' | 'z', UInt & { addAssign(n: Node): void; assign(n: Node): void }>

/**
 * Gradient of a cell of the lattice, components in [−1, 1), each a multiple of 2⁻²²: exact in float32.
 *
 * @param cell - Indices, two's complement.
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", JCGT 9 (3), supplement: pcg3d. Twin: ../cpu/latticeNoise.ts
 */
export const latticeGradient = /*#__PURE__*/ Fn(
  ([cell]: [UVec3]) => {
    const v = cell.mul(uint(1664525)).add(uint(1013904223)).toVar() as never as UVariable
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
    const mantissa = shiftRight(uvec3(v.x, v.y, v.z) as never, uvec3(9) as never)
    const bits = bitOr(mantissa, uvec3(ONE) as never)
    return (uintBitsToFloat(bits) as unknown as Vec3).mul(2).sub(3)
  },
  layout('welkinLatticeGradient', 'vec3', { cell: 'uvec3' })
) as unknown as (cell: UVec3) => Vec3

/**
 * Gradient noise on a lattice that is fixed to the planet, without a period, and its own gradient.
 *
 * A place is a whole number of 256 m steps from the planet's centre and the rest: cells and parts of
 * cells come out exact in float32 and integers, so that the float64 twin agrees wherever one stands.
 *
 * @param reference - Point near the place, whole multiples of 256 m, ECEF axes [256 m].
 * @param offset - Place relative to the reference [m].
 * @param inverse - 1 / wavelength, a power of two [1/m].
 * @param seed - Whole number ≥ 0: another one, other noise.
 * @returns Gradient per wavelength (xyz) and value (w): about ±0.6, at most ±1.5.
 * @see Perlin 2002, "Improving noise", §2, on the quintic. Twin: ../cpu/latticeNoise.ts
 */
export const latticeNoise = /*#__PURE__*/ Fn(
  ([reference, offset, inverse, seed]: [Vec3, Vec3, Float, Float]) => {
    const scaled = inverse.mul(REFERENCE_STEP).toConst()
    const coarse = scaled.min(1).toConst()
    const base = reference.mul(coarse).floor().toConst()
    // Products with a power of two are exact; the rest is 0 where cells are smaller than steps.
    const p = reference.mul(coarse).sub(base).add(offset.mul(inverse)).toConst()
    const corner = p.floor().toConst()
    const part = p.sub(corner).toConst()
    const fine = scaled.max(1)
    const origin = uvec3(ivec3(base.mul(fine)).add(ivec3(corner)))
      .add(uvec3(uint(seed).mul(uint(747796405)), uint(0), uint(seed)))
      .toConst()

    const square = part.mul(part).toConst()
    const cubic = square.mul(part)
    const blend = cubic.mul(part.mul(part.mul(6).sub(15)).add(10)).toConst()
    const slope = square
      .mul(part.mul(part.sub(2)).add(1))
      .mul(30)
      .toConst()
    const sum = vec4(0).toVar()
    for (let i = 0; i < 8; i++) {
      const [x, y, z] = [i & 1, (i >> 1) & 1, i >> 2]
      const sign = [x, y, z].map(part => 2 * part - 1) as Triple
      const gradient = latticeGradient(origin.add(uvec3(x, y, z))).toConst()
      const value = gradient.dot(part.sub(vec3(x, y, z))).toConst()
      // Weights along the axes: the blend towards corners beyond, and what it leaves.
      const w = blend
        .mul(vec3(...sign))
        .add(vec3(1 - x, 1 - y, 1 - z))
        .toConst() as Vec3
      const turn = w.yzx
        .mul(w.zxy)
        .mul(vec3(...sign))
        .mul(slope)
      const weight = w.x.mul(w.y).mul(w.z)
      sum.addAssign(vec4(gradient.mul(weight).add(turn.mul(value)), value.mul(weight)))
    }
    return sum
  },
  layout('welkinLatticeNoise', 'vec4', {
    reference: 'vec3',
    offset: 'vec3',
    inverse: 'float',
    seed: 'float'
  })
) as unknown as (reference: Vec3, offset: Vec3, inverse: Float, seed: Float) => Vec4
