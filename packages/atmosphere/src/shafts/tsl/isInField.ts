import { step, vec2 } from 'three/tsl'
import type { Float, Vec2 } from '../../tsl-types'

/** 1 for places in [0, 1]², 0 for others. */
export function isInField(place: Vec2): Float {
  const inside = step(0, place).mul(step(place, vec2(1))) as unknown as Vec2
  return inside.x.mul(inside.y)
}
