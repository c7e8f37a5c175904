import { Fn, float, mix, uint, uvec3, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { loop, type Vec3 } from '../../tsl-types'

/** Operations on unsigned vectors that `@types/three` lacks. */
interface Words extends Node {
  x: Words
  y: Words
  z: Words
  add(other: unknown): Words
  mul(other: unknown): Words
  bitXor(other: unknown): Words
  shiftRight(other: unknown): Words
  toVar(): Words
  addAssign(other: unknown): void
}

function stir(v: Words): void {
  v.x.addAssign(v.y.mul(v.z))
  v.y.addAssign(v.z.mul(v.x))
  v.z.addAssign(v.x.mul(v.y))
}

/**
 * Three random numbers for a cell of a lattice, in [0, 1).
 *
 * @param cell - Whole numbers above −2¹⁴.
 * @see Jarzynski & Olano 2020, "Hash functions for GPU rendering", JCGT 9 (3), supplement: pcg3d
 */
export function cellRandom(cell: Vec3): Vec3 {
  const words = uvec3(cell.add(2 ** 14 + 0.5) as never) as unknown as Words
  const v = words.mul(uint(1664525)).add(uint(1013904223)).toVar()
  stir(v)
  const folded = v.bitXor(v.shiftRight(uvec3(16))).toVar()
  stir(folded)
  return (vec3(folded.shiftRight(uvec3(8)) as never) as Vec3).mul(2 ** -24)
}

/** Smooth noise in three channels, in [−1, 1]: random values at whole numbers, blended. */
const valueNoise = /*#__PURE__*/ Fn(
  ([position]: [Vec3]) => {
    const cell = position.floor().toConst() as Vec3
    const part = position.sub(cell).toConst()
    const weight = part.mul(part).mul(part.mul(-2).add(3)).toConst()
    const sum = vec3(0).toVar()
    loop('corner', 8, corner => {
      const index = float(corner).add(0.5)
      const offset = vec3(index, index.div(2), index.div(4)).floor().mod(2).toConst()
      const near = mix(weight.oneMinus(), weight, offset).toConst()
      sum.addAssign(cellRandom(cell.add(offset)).mul(near.x.mul(near.y).mul(near.z)))
    })
    return sum.mul(2).sub(1)
  },
  { name: 'welkinValueNoise', type: 'vec3', inputs: [{ name: 'position', type: 'vec3' }] }
) as unknown as (position: Vec3) => Vec3

/**
 * Noise of several sizes in three channels, about [−1, 1].
 *
 * @param octaves - Each 2.1 times as fine as the one before, and 0.6 times as strong.
 */
export function fractalNoise(position: Vec3, octaves: number): Vec3 {
  const sum = vec3(0).toVar()
  const at = position.toVar()
  const strength = float(1).toVar()
  loop('octave', octaves, () => {
    sum.addAssign(valueNoise(at).mul(strength))
    // Turned, or the lattices of all octaves would show the same edges.
    const turned = vec3(at.x.mul(0.8).sub(at.y.mul(0.6)), at.x.mul(0.6).add(at.y.mul(0.8)), at.z)
    at.assign(turned.zxy.mul(2.1).add(3.7))
    strength.mulAssign(0.6)
  })
  return sum.mul(0.8)
}
