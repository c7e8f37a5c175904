import { Fn, bitXor, float, floor, int, shiftRight, uint, uvec3, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layout, loop, type Float, type Int, type Vec3 } from '../../tsl-types'

type UVec3 = Node<'uvec3'>

/**
 * Three numbers in [0, 1) for a cell of a lattice, each a multiple of 2⁻²⁴: exact in float32.
 *
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", on PCG3D. Twin: test/twins/noise.ts
 */
export const hashCell = /*#__PURE__*/ Fn(
  ([cell]: [UVec3]) => {
    const v = cell.mul(uint(1664525)).add(uint(1013904223)).toVar() as never as Record<
      'x' | 'y' | 'z',
      Node<'uint'> & { addAssign: (n: Node) => void; assign: (n: Node) => void }
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
    const part = (n: Node<'uint'>): Float => float(shiftRight(n as never, uint(8))).div(2 ** 24)
    return vec3(part(v.x), part(v.y), part(v.z))
  },
  layout('welkinHashCell', 'vec3', { cell: 'uvec3' })
) as unknown as (cell: UVec3) => Vec3

/** The cell of a lattice that repeats after `cells`, and of a seed. `corner` is whole, ≥ −cells. */
const cellAt = (corner: Vec3, cells: Vec3, seed: Float): UVec3 => {
  // + ½: the division is not exact on every GPU.
  const turns = floor(corner.add(0.5).div(cells))
  const wrapped = corner.sub(turns.mul(cells))
  return uvec3(wrapped.add(vec3(0, 0, seed)).add(0.5))
}

/** Corner of a cell from its index: a digit for each coordinate. */
const offsetOf = (index: Int, base: number): Vec3 =>
  vec3(index.mod(int(base)), index.div(int(base)).mod(int(base)), index.div(int(base * base)))

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
    const base = p.mul(cells).floor().toConst('base')
    const part = p.mul(cells).sub(base).toConst('part')
    const fade = part
      .mul(part)
      .mul(part)
      .mul(part.mul(part.mul(6).sub(15)).add(10))
      .toConst('fade')
    const sum = float(0).toVar('sum')
    loop('corner', 8, index => {
      const offset = offsetOf(index, 2).toConst('offset')
      const gradient = hashCell(cellAt(base.add(offset), cells, seed))
        .mul(2)
        .sub(1)
      const weights = offset.mul(fade.mul(2).sub(1)).add(fade.oneMinus()).toConst('weights')
      const weight = weights.x.mul(weights.y).mul(weights.z)
      sum.addAssign(weight.mul(gradient.dot(part.sub(offset))))
    })
    return sum.mul(1.5)
  },
  layout('welkinPerlin', 'float', { p: 'vec3', cells: 'vec3', seed: 'float' })
) as unknown as (p: Vec3, cells: Vec3, seed: Float) => Float

/**
 * 1 − F₁², with F₁ the distance to the nearest of the points scattered one in each cell: round heads
 * that meet in sharp creases, as on cauliflowers. Period 1, in [0, 1]. Parameters as of `perlin`.
 *
 * @see Worley 1996, "A cellular texture basis function", on F₁. Twin: test/twins/noise.ts
 */
export const billow = /*#__PURE__*/ Fn(
  ([p, cells, seed]: [Vec3, Vec3, Float]) => {
    const base = p.mul(cells).floor().toConst('base')
    const part = p.mul(cells).sub(base).toConst('part')
    const nearest = float(1).toVar('nearest')
    loop('neighbour', 27, index => {
      const offset = offsetOf(index, 3).sub(1).toConst('offset')
      const point = hashCell(cellAt(base.add(offset), cells, seed))
      const gap = offset.add(point).sub(part).toConst('gap')
      nearest.assign(nearest.min(gap.dot(gap)))
    })
    return nearest.oneMinus()
  },
  layout('welkinBillow', 'float', { p: 'vec3', cells: 'vec3', seed: 'float' })
) as unknown as (p: Vec3, cells: Vec3, seed: Float) => Float
