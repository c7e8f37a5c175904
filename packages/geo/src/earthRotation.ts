import { Rotation_EQJ_EQD, SiderealTime } from 'astronomy-engine'
import { Matrix4 } from 'three'
import { checkDate } from './check'

/**
 * Greenwich apparent sidereal time as an angle: how far the prime meridian is east of the true
 * equinox of date.
 *
 * UT1 is taken equal to UTC, which is off by 0.9 s (14″) at most, and polar motion is left out.
 *
 * @param date - Instant, UTC.
 * @returns In [0, 2π) [rad].
 * @throws Error if the date is invalid.
 */
export function siderealAngle(date: Date): number {
  checkDate('siderealAngle', date)
  return (SiderealTime(date) * Math.PI) / 12
}

/**
 * Rotation from the inertial frame of the stars to ECEF: precession, nutation and the turn of the
 * Earth.
 *
 * The inertial frame (ECI) has the mean equator and equinox of J2000, within 0.02″ of ICRF: star
 * catalogues' right ascension and declination are angles in it.
 *
 * @param date - Instant, UTC.
 * @returns Rotation matrix: ECEF = M · ECI.
 * @throws Error if the date is invalid.
 */
export function eciToECEF(date: Date, target: Matrix4 = new Matrix4()): Matrix4 {
  checkDate('eciToECEF', date)
  const angle = siderealAngle(date)
  const c = Math.cos(angle)
  const s = Math.sin(angle)
  // astronomy-engine keeps columns: rot[i][j] is the j-th coordinate of the image of axis i.
  const { rot } = Rotation_EQJ_EQD(date)
  const column = (i: number): [number, number, number] => {
    const [x = 0, y = 0, z = 0] = rot[i] ?? []
    return [c * x + s * y, c * y - s * x, z]
  }
  const [xx, xy, xz] = column(0)
  const [yx, yy, yz] = column(1)
  const [zx, zy, zz] = column(2)
  // prettier-ignore
  return target.set(
    xx, yx, zx, 0,
    xy, yy, zy, 0,
    xz, yz, zz, 0,
    0, 0, 0, 1
  )
}
