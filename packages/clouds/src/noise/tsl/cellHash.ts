import { Fn, bitOr, bitXor, floor, shiftRight, uint, uintBitsToFloat, uvec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layout, type Float, type Int, type Vec3 } from '../../tsl-types'

// Cells of a lattice that repeats, and random numbers for each: what noise is made from.

export type UInt = Node<'uint'>
export type UVec3 = Node<'uvec3'>

/**
 * 96 bits for a cell of a lattice.
 *
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", JCGT 9 (3), supplement: pcg3d. Twin: test/twins/noise.ts
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

/** Bits of the number 1, with which those of all numbers in [1, 2) begin. */
export const ONE = 0x3f800000

/** Numbers of their bits as float32. */
export const fromBits = (bits: Node): Vec3 => uintBitsToFloat(bits) as unknown as Vec3

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
export const wrapped = (corner: Vec3, cells: Vec3): UVec3 => {
  // + ½: the division is not exact on every GPU.
  const periods = floor(corner.add(0.5).div(cells))
  return uvec3(corner.sub(periods.mul(cells)).add(0.5))
}

/** A place's cell, with its index for `hashBits`. */
export const cellOf = (
  p: Vec3,
  cells: Vec3,
  seed: Float
): { base: Vec3; part: Vec3; origin: UVec3; index: UVec3 } => {
  const base = p.mul(cells).floor().toConst()
  const part = p.mul(cells).sub(base).toConst()
  const origin = wrapped(base, cells).toConst()
  const index = origin.add(uvec3(0, 0, uint(seed.add(0.5)))).toConst()
  return { base, part, origin, index }
}

/** Digits of a number below base³: one for each coordinate. */
export const digitsOf = (number: Int, base: number): UVec3 => {
  const n = uint(number)
  return uvec3(n.mod(uint(base)), n.div(uint(base)).mod(uint(base)), n.div(uint(base * base)))
}
