import { vec4 } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'

/** Vector with 1 in the component of an index and 0 in the others: reads and writes by an index of a variable. */
export const componentAt = (index: Float): Vec4 =>
  vec4(0, 1, 2, 3).sub(index).abs().min(1).oneMinus().toConst()
