import type { Float, Vec3 } from '../tsl-types'

/** A place in the air, as seen from the field's camera. Vectors are in the mapped space. */
export interface CloudSample {
  /** Displacement from the camera [m]. */
  offset: Vec3
  /** Altitude above the sphere: `ViewNodes.localCoordinates(offset).altitude` [m]. */
  altitude: Float
  /** Zenith there, unit length. */
  up: Vec3
  /** Distance from the camera, which sets the level of detail [m]. */
  distance: Float
  /** Footprints by which billows are looked up; left out, `billowForm.footprints`. Shadow maps take 1: they show no moss. */
  billowFootprints?: number
}
