import type { CloudField } from '../CloudField'
import type { Float, Vec3 } from '../../tsl-types'

/** A place in the air, as seen from the field's camera. */
export interface CloudSample {
  /** From the camera, in the mapped space [m]. */
  offset: Vec3
  /** Above the sphere [m]: `ViewNodes.place(offset).altitude`. */
  altitude: Float
  /** Zenith there, unit length. */
  up: Vec3
  /** From the camera [m]: sets the level of detail. */
  distance: Float
}

/**
 * From the point of the ground below the camera to that below a sample, in the mapped space [m]:
 * (d − (h − h_c) u_c) R/r, which does not cancel.
 */
export function footOffset(field: CloudField, { offset, altitude }: CloudSample): Vec3 {
  const { up, height } = field.view
  const rise = altitude.sub(height)
  const scale = field.radius.div(field.radius.add(altitude))
  return offset.sub(up.mul(rise)).mul(scale)
}
