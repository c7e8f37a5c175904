import type { Vector3 } from 'three'

/** Place on an ellipsoid as angles. */
export interface GeographicPlace {
  /** East, in (−π, π] [rad]. */
  longitude: number
  /** Geodetic [rad]. */
  latitude: number
}

/** Row of a latitude on a map of longitude and latitude: 0 at the north pole, 1 at the south pole. */
export const geographicY = (latitude: number): number => 0.5 - latitude / Math.PI

/**
 * Geodetic longitude and latitude of a point on an ellipsoid: those of its normal.
 *
 * @param positionECEF - On the ellipsoid [m].
 * @param radii - Radii of the ellipsoid [m].
 */
export function geographicPlace(
  { x, y, z }: Vector3,
  radii: Vector3,
  target: GeographicPlace
): GeographicPlace {
  const nx = x / radii.x ** 2
  const ny = y / radii.y ** 2
  target.longitude = Math.atan2(ny, nx)
  target.latitude = Math.atan2(z / radii.z ** 2, Math.sqrt(nx * nx + ny * ny))
  return target
}

/**
 * Gradient of a height on an ellipsoid of revolution, from its slopes by angle.
 *
 * @param byLongitude - Slope along longitude [m/rad], like `byLatitude`.
 * @param positionECEF - On the ellipsoid [m].
 * @param target - Receives the gradient, ECEF axes [–].
 */
export function geographicGradient(
  { longitude, latitude }: GeographicPlace,
  byLongitude: number,
  byLatitude: number,
  { x, y }: Vector3,
  radii: Vector3,
  target: Vector3
): Vector3 {
  const cosLatitude = Math.cos(latitude)
  const sinLatitude = Math.sin(latitude)
  const cosLongitude = Math.cos(longitude)
  const sinLongitude = Math.sin(longitude)
  // Radius of curvature of the meridian, and distance from the axis.
  const support = Math.sqrt((radii.x * cosLatitude) ** 2 + (radii.z * sinLatitude) ** 2)
  const meridian = (radii.x * radii.z) ** 2 / support ** 3
  const distance = Math.max(Math.sqrt(x * x + y * y), 1)
  const east = byLongitude / distance
  const north = byLatitude / meridian
  return target.set(
    -sinLongitude * east - sinLatitude * cosLongitude * north,
    cosLongitude * east - sinLatitude * sinLongitude * north,
    cosLatitude * north
  )
}
