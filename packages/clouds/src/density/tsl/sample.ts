import type { CloudField } from '../CloudField'
import type { CloudSample } from '../CloudSample'
import type { Float, Vec3 } from '../../tsl-types'

export type { CloudSample }

/** Width of what a sample stands for: a pixel's, or more [m]. */
export const footprintOf = (field: CloudField, { distance }: CloudSample): Float =>
  distance.mul(field.pixelAngle).toConst()

/**
 * Displacement from the camera's subpoint to a sample's, in the mapped space [m]. A subpoint is the point
 * of the sphere straight below. (d − (h − h_c) u_c) R/r, which does not cancel.
 */
export function subpointOffset(field: CloudField, { offset, altitude }: CloudSample): Vec3 {
  const { up, height } = field.view
  const rise = altitude.sub(height)
  const scale = field.radius.div(field.radius.add(altitude))
  return offset.sub(up.mul(rise)).mul(scale)
}

/** Zenith over a displacement from the camera's subpoint, in the mapped space. */
export const zenithAt = ({ view, radius }: CloudField, subpoint: Vec3): Vec3 =>
  view.up.mul(radius).add(subpoint).normalize().toConst()
