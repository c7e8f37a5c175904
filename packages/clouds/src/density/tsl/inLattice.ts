import { vec3 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'

/**
 * Displacement in a lattice by two numbers: its third component has none of its own, since where the lattice
 * stands upright it is horizontal.
 */
export const inLattice = (displacement: Vec2): Vec3 =>
  vec3(displacement, displacement.x.sub(displacement.y).mul(Math.SQRT1_2))
