import { asin, atan, vec2 } from 'three/tsl'
import type { Vec2, Vec3 } from '../../tsl-types'

/** Equirectangular texture coordinates of a normal: north on top, longitude −180° at the left edge. */
export function equirectangular(normal: Vec3): Vec2 {
  const longitude = atan(normal.y, normal.x)
  return vec2(longitude.div(2 * Math.PI), asin(normal.z.clamp(-1, 1)).div(Math.PI)).add(0.5)
}

/** Change of those coordinates with a small step of the normal. */
export function equirectangularStep(normal: Vec3, step: Vec3): Vec2 {
  const level = normal.x.mul(normal.x).add(normal.y.mul(normal.y)).max(1e-6).toConst()
  const longitude = normal.x.mul(step.y).sub(normal.y.mul(step.x)).div(level)
  const latitude = step.z.div(level.sqrt())
  return vec2(longitude.div(2 * Math.PI), latitude.div(Math.PI)).clamp(-0.25, 0.25)
}
