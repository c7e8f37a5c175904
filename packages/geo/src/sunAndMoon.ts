import { Body, GeoMoon, GeoVector, KM_PER_AU } from 'astronomy-engine'
import { Matrix4, Vector3 } from 'three'
import { checkDate } from './check'
import { eciToECEF } from './earthRotation'

/** Metres in an astronomical unit. */
const astronomicalUnit = KM_PER_AU * 1000

/**
 * Apparent position of the sun's centre from the Earth's centre (light time and aberration
 * included).
 *
 * @param date - Instant, UTC.
 * @returns ECEF [m].
 * @throws Error if the date is invalid.
 * @see astronomy-engine (VSOP87, IAU 2000B nutation): better than 1′, as the tests hold it to.
 */
export function sunPositionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('sunPositionECEF', date)
  const { x, y, z } = GeoVector(Body.Sun, date, true)
  return target
    .set(x, y, z)
    .multiplyScalar(astronomicalUnit)
    .applyMatrix4(eciToECEF(date, scratchRotation))
}

/**
 * Unit direction from the Earth's centre to the sun. From its surface the sun is within 9″ of it.
 *
 * @param date - Instant, UTC.
 * @returns ECEF.
 * @throws Error if the date is invalid.
 */
export function sunDirectionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('sunDirectionECEF', date)
  return sunPositionECEF(date, target).normalize()
}

/**
 * Position of the moon's centre from the Earth's centre.
 *
 * @param date - Instant, UTC.
 * @returns ECEF [m].
 * @throws Error if the date is invalid.
 * @see astronomy-engine (Montenbruck & Pfleger's lunar theory): better than 1′, as the tests hold
 *   it to.
 */
export function moonPositionECEF(date: Date, target: Vector3 = new Vector3()): Vector3 {
  checkDate('moonPositionECEF', date)
  const { x, y, z } = GeoMoon(date)
  return target
    .set(x, y, z)
    .multiplyScalar(astronomicalUnit)
    .applyMatrix4(eciToECEF(date, scratchRotation))
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
  return moonPositionECEF(date, target).normalize()
}

const scratchRotation = /*#__PURE__*/ new Matrix4()
