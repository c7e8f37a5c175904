import { Body, GeoVector } from 'astronomy-engine'
import { Matrix4, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  eciToECEF,
  Ellipsoid,
  moonDirectionECEF,
  moonOrientation,
  moonPositionECEF,
  siderealAngle,
  sunDirectionECEF,
  sunPositionECEF
} from '@welkin/geo'

const degree = Math.PI / 180
const arcminute = 1 / 60
const astronomicalUnit = 149597870700

const dms = (degrees: number, minutes: number, seconds: number): number =>
  degrees + minutes / 60 + seconds / 3600

/** Signed difference of angles [degrees]. */
const difference = (a: number, b: number): number => ((((a - b + 180) % 360) + 360) % 360) - 180

const longitudeOf = (v: Vector3): number => Math.atan2(v.y, v.x) / degree
const latitudeOf = (v: Vector3): number => Math.asin(v.z / v.length()) / degree

/** Greenwich apparent sidereal time [degrees], Meeus eq. 12.4 and the equation of the equinoxes. */
function meeusSidereal(date: Date, equationOfEquinoxes: number): number {
  const days = date.getTime() / 86400e3 + 2440587.5 - 2451545
  return 280.46061837 + 360.98564736629 * days + equationOfEquinoxes
}

function expectDirection(v: Vector3, longitude: number, latitude: number, tolerance: number): void {
  const apart = Math.cos(latitude * degree) * difference(longitudeOf(v), longitude)
  expect(Math.abs(apart)).toBeLessThan(tolerance)
  expect(Math.abs(latitudeOf(v) - latitude)).toBeLessThan(tolerance)
}

describe('sidereal time', () => {
  it.each([
    // Apparent: 13h 10m 46.1351s.
    ['Meeus 12.a', '1987-04-10T00:00:00Z', dms(13, 10, 46.1351), 0.1],
    // Mean: 8h 34m 57.0896s; apparent is within 1.2 s of it at any time.
    ['Meeus 12.b', '1987-04-10T19:21:00Z', dms(8, 34, 57.0896), 1.2]
  ])('%s', (_, date, hours, toleranceSeconds) => {
    const error = siderealAngle(new Date(date)) / degree / 15 - hours
    expect(Math.abs(error) * 3600).toBeLessThan(toleranceSeconds)
  })
})

describe('the inertial frame', () => {
  it('precesses θ Persei as Meeus 21.b, and nutates it as 23.a, within 2″', () => {
    const date = new Date(Date.UTC(2028, 10, 13) + 0.19 * 86400e3 - 69.2e3)
    const star = (rightAscension: number, declination: number): Vector3 =>
      new Vector3().setFromSphericalCoords(1, (90 - declination) * degree, rightAscension * degree)
    const atJ2000 = star(41.054063, 49.22775)
    const ofDate = star(41.547214 + 15.843 / 3600, 49.348483 + 6.217 / 3600)
    // three's spherical coordinates have Y for the pole and Z for the origin of angles.
    const toZUp = ({ x, y, z }: Vector3): Vector3 => new Vector3(z, x, y)
    const expected = toZUp(ofDate).applyAxisAngle(new Vector3(0, 0, 1), -siderealAngle(date))
    const actual = toZUp(atJ2000).applyMatrix4(eciToECEF(date))
    expect(actual.angleTo(expected) / degree).toBeLessThan(2 / 3600)
  })

  it('is a rotation that turns once in a sidereal day of 86164.0905 s', () => {
    const start = new Date('2026-06-21T00:00:00Z')
    const matrix = eciToECEF(start)
    expect(matrix.determinant()).toBeCloseTo(1, 13)
    const later = eciToECEF(new Date(start.getTime() + 86164090.5))
    matrix.elements.forEach((value, i) => expect(later.elements[i]).toBeCloseTo(value, 5))
  })
})

describe('the sun', () => {
  it('Meeus 25.b: 1992 October 13 at 0h TD, and 28.a: the equation of time', () => {
    const date = new Date('1992-10-12T23:59:01Z')
    const sun = sunPositionECEF(date)
    const rightAscension = 15 * dms(13, 13, 30.749)
    const sidereal = meeusSidereal(date, (15.908 / 3600) * 0.9175)
    expectDirection(sun, rightAscension - sidereal, -dms(7, 47, 1.74), arcminute / 2)
    expect(sun.length() / astronomicalUnit).toBeCloseTo(0.99760775, 4)
    const clock = 15 * (dms(23, 59, 1) - 12)
    expect(Math.abs(difference(longitudeOf(sun), -clock - 3.427351))).toBeLessThan(arcminute)
  })

  it('NREL solar position algorithm, appendix A.5: 2003 October 17, Golden', () => {
    const date = new Date('2003-10-17T19:30:30Z')
    const sun = sunPositionECEF(date)
    // Observer's longitude less the local hour angle; geocentric declination; distance.
    expectDirection(sun, -105.1786 - 11.1059, -9.31434, arcminute / 2)
    expect(sun.length() / astronomicalUnit).toBeCloseTo(0.9965422974, 4)
    // Topocentric elevation before refraction.
    const observer = Ellipsoid.WGS84.geodeticToECEF({
      longitude: -105.1786,
      latitude: 39.742476,
      height: 1830.14
    })
    const up = Ellipsoid.WGS84.surfaceNormal(observer)
    const elevation = Math.asin(sun.sub(observer).normalize().dot(up)) / degree
    expect(Math.abs(elevation - 39.872046)).toBeLessThan(arcminute)
  })

  it.each([
    // US Naval Observatory, Earth's seasons, to the minute; a minute is 1″ of declination.
    ['2024-03-20T03:06:00Z', 0],
    ['2024-06-20T20:51:00Z', 23.4384],
    ['2024-09-22T12:44:00Z', 0],
    ['2024-12-21T09:21:00Z', -23.4384]
  ])('has the declination of the season at %s', (date, declination) => {
    const sun = sunDirectionECEF(new Date(date))
    expect(Math.abs(latitudeOf(sun) - declination)).toBeLessThan(arcminute / 2)
  })

  it.each([
    ['perihelion 2024', '2024-01-03T00:38:00Z', 147100632e3],
    ['aphelion 2024', '2024-07-05T05:06:00Z', 152099968e3]
  ])('%s', (_, date, distance) => {
    expect(Math.abs(sunPositionECEF(new Date(date)).length() / distance - 1)).toBeLessThan(5e-5)
  })

  it('is within 15″ of the full theory from 1800 to 2200', () => {
    const start = Date.UTC(1800, 0, 1)
    const span = Date.UTC(2200, 0, 1) - start
    for (let i = 0; i < 2000; ++i) {
      const date = new Date(start + ((i * 0.6180339887) % 1) * span)
      const { x, y, z } = GeoVector(Body.Sun, date, true)
      const full = new Vector3(x, y, z).applyMatrix4(eciToECEF(date))
      const sun = sunPositionECEF(date)
      expect(sun.angleTo(full) / degree).toBeLessThan(15 / 3600)
      expect(Math.abs(sun.length() / astronomicalUnit / full.length() - 1)).toBeLessThan(4e-5)
    }
  })
})

describe('the moon', () => {
  // 0h TD; ΔT was 58.7 s.
  const meeusDate = new Date('1992-04-11T23:59:01.3Z')

  it('Meeus 47.a: 1992 April 12 at 0h TD', () => {
    const moon = moonPositionECEF(meeusDate)
    const sidereal = meeusSidereal(meeusDate, 0.00461 * 0.9175)
    expectDirection(moon, 134.68847 - sidereal, 13.768368, arcminute / 2)
    expect(Math.abs(moon.length() - 368409.7e3)).toBeLessThan(20e3)
  })

  it('perigee of 2016 November 14 (Espenak): 356,509 km', () => {
    const distance = moonPositionECEF(new Date('2016-11-14T11:23:00Z')).length()
    expect(Math.abs(distance - 356509e3)).toBeLessThan(20e3)
  })

  // Greatest eclipse: instant, place and the sun's altitude there (Espenak & Meeus, NASA).
  it.each([
    ['2017-08-21T18:25:31.8Z', dms(36, 58, 0), -dms(87, 40, 18), 63.9],
    ['2024-04-08T18:17:15.6Z', dms(25, 17, 24), -dms(104, 8, 18), 69.8],
    ['2009-07-22T02:35:19Z', dms(24, 12, 36), dms(144, 6, 24), 85.9]
  ])('stands before the sun at the eclipse of %s', (instant, latitude, longitude, altitude) => {
    const date = new Date(instant)
    const observer = Ellipsoid.WGS84.geodeticToECEF({ longitude, latitude })
    const sun = sunPositionECEF(date).sub(observer)
    const moon = moonPositionECEF(date).sub(observer)
    expect(sun.angleTo(moon) / degree).toBeLessThan(arcminute)
    const up = Ellipsoid.WGS84.surfaceNormal(observer)
    expect(90 - sun.angleTo(up) / degree).toBeCloseTo(altitude, 0)
  })

  it('librates as Meeus 53.a: sub-Earth point and position angle of the axis', () => {
    const orientation = moonOrientation(meeusDate)
    const moon = moonPositionECEF(meeusDate)
    const earth = moon.clone().negate().applyQuaternion(orientation.clone().invert())
    expect(longitudeOf(earth)).toBeCloseTo(-1.23, 1)
    expect(latitudeOf(earth)).toBeCloseTo(4.2, 1)
    const axis = new Vector3(0, 0, 1).applyQuaternion(orientation)
    const east = new Vector3(0, 0, 1).cross(moon).normalize()
    const north = moon.clone().cross(east).normalize()
    const positionAngle = Math.atan2(axis.dot(east), axis.dot(north)) / degree
    expect(positionAngle).toBeCloseTo(15.08, 1)
  })

  it('keeps its face to the Earth within the bounds of libration', () => {
    for (let day = 0; day < 400; day += 3) {
      const date = new Date(Date.UTC(2026, 0, 1 + day))
      const moon = moonDirectionECEF(date)
      const near = new Vector3(1, 0, 0).applyQuaternion(moonOrientation(date))
      expect(near.angleTo(moon.negate()) / degree).toBeLessThan(10.5)
      expect(
        new Matrix4().makeRotationFromQuaternion(moonOrientation(date)).determinant()
      ).toBeCloseTo(1, 12)
    }
  })
})

it('writes into the target', () => {
  const date = new Date('2026-06-21T09:30:00Z')
  const target = new Vector3()
  expect(sunDirectionECEF(date, target)).toBe(target)
  expect(target.length()).toBeCloseTo(1, 14)
  expect(moonPositionECEF(date, target)).toBe(target)
})
