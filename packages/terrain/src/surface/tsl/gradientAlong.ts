import type { Vec3 } from '../../tsl-types'

/** Part of a gradient along the ellipsoid. */
export const gradientAlong = (gradient: Vec3, up: Vec3): Vec3 =>
  gradient.sub(up.mul(gradient.dot(up)))
