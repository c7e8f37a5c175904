import { Body, GeoMoon, KM_PER_AU, RotationAxis } from 'astronomy-engine'
import { Matrix4, Quaternion, Vector3 } from 'three'
import { checkDate } from './check'
import { eciToECEF } from './earthRotation'

/**
 * Position of the moon's centre from the Earth's centre.
 *
 * @param date - Instant, UTC.
 * @returns ECEF [m].
 * @throws Error if the date is invalid.
 * @see astronomy-engine, after Montenbruck & Pfleger's lunar theory. Better than 1′.
 */
export function moonPositionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('moonPositionECEF', date)
  return computeMoonPosition(date, target)
}

/**
 * Unit direction from the Earth's centre to the moon. An observer on the ground sees it up to 1°
 * away from this: subtract the observer from `moonPositionECEF` where that matters.
 *
 * @param date - Instant, UTC.
 * @returns ECEF.
 * @throws Error if the date is invalid.
 */
export function moonDirectionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('moonDirectionECEF', date)
  return computeMoonPosition(date, target).normalize()
}

/**
 * Orientation of the moon, libration included: the rotation from moon-fixed axes to ECEF.
 *
 * Moon-fixed axes are the IAU's: Z through the moon's north pole, X through selenographic longitude
 * 0° (the middle of the near side), Y through 90° east. A moon texture in equirectangular
 * projection with longitude 0° in its middle sits on a sphere with these axes.
 *
 * @param date - Instant, UTC.
 * @throws Error if the date is invalid.
 * @see Archinal et al. 2018, Report of the IAU Working Group on Cartographic Coordinates and Rotational
 *   Elements: 2015, table 2, through astronomy-engine.
 */
export function moonOrientation(date: Date, target: Quaternion = new Quaternion()): Quaternion {
  checkDate('moonOrientation', date)
  const axis = RotationAxis(Body.Moon, date)
  const ascension = (axis.ra * Math.PI) / 12
  const spin = (axis.spin * Math.PI) / 180
  const north = new Vector3(axis.north.x, axis.north.y, axis.north.z)
  // The prime meridian turns from the node where the moon's equator rises through ECI's.
  const node = new Vector3(-Math.sin(ascension), Math.cos(ascension), 0)
  const prime = node.applyAxisAngle(north, spin)
  const east = new Vector3().crossVectors(north, prime)
  const moonToECI = new Matrix4().makeBasis(prime, east, north)
  return target.setFromRotationMatrix(moonToECI.premultiply(eciToECEF(date)))
}

function computeMoonPosition(date: Date, target: Vector3): Vector3 {
  const { x, y, z } = GeoMoon(date)
  return target
    .set(x, y, z)
    .multiplyScalar(KM_PER_AU * 1000)
    .applyMatrix4(eciToECEF(date))
}
