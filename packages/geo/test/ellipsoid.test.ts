import fc from 'fast-check'
import { Matrix4, Vector3 } from 'three'
import { Ellipsoid as TilesEllipsoid } from '3d-tiles-renderer/three'
import { describe, expect, it } from 'vitest'
import { Ellipsoid } from '@welkin/geo'
import { direction, latitude, longitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84
const micrometre = 1e-6

const dms = (degrees: number, minutes: number, seconds: number): number =>
  degrees + minutes / 60 + seconds / 3600

/** Longitude, latitude, height, then X, Y, Z as published. */
const published: [string, number, number, number, number, number, number, digits: number][] = [
  [
    'IOGP Geomatics Guidance Note 7-2, method 9602',
    dms(2, 7, 46.38),
    dms(53, 48, 33.82),
    73,
    3771793.968,
    140253.342,
    5124304.349,
    3
  ],
  ['GeographicLib, CartConvert(1)', 44.4, 33.3, 6000, 3816209.6, 3737108.55, 3485109.57, 2],
  ['semi-major axis', 0, 0, 0, 6378137, 0, 0, 6],
  ['semi-minor axis, NGA.STND.0036', 12, 90, 0, 0, 0, 6356752.3142, 4],
  ['south pole', -120, -90, 100, 0, 0, -6356852.3142, 4],
  ['antimeridian', 180, 0, 10, -6378147, 0, 0, 6]
]

describe('geodetic coordinates', () => {
  it.each(published)('%s: to ECEF', (_, lon, lat, height, x, y, z, digits) => {
    const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
    const error = position.distanceTo(new Vector3(x, y, z))
    expect(error).toBeLessThan(10 ** -digits)
  })

  it.each(published)('%s: from ECEF', (_, lon, lat, height, x, y, z, digits) => {
    const place = earth.ecefToGeodetic(new Vector3(x, y, z))
    expect(Math.abs(place.height - height)).toBeLessThan(10 ** -digits)
    expect(Math.abs(place.latitude - lat) * 111e3).toBeLessThan(10 ** -digits)
    if (Math.abs(lat) < 90) {
      expect(Math.abs(place.longitude - lon) * 111e3).toBeLessThan(10 ** -digits)
    }
  })

  it('agrees with 3d-tiles-renderer', () => {
    const tiles = new TilesEllipsoid(earth.radii.x, earth.radii.y, earth.radii.z)
    fc.assert(
      fc.property(longitude, latitude, number(-1e4, 1e6), (lon, lat, height) => {
        const ours = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const degrees = Math.PI / 180
        const theirs = tiles.getCartographicToPosition(
          lat * degrees,
          lon * degrees,
          height,
          new Vector3()
        )
        expect(ours.distanceTo(theirs)).toBeLessThan(1e-8)
      }),
      runs
    )
    expect(Ellipsoid.from(tiles).radii).toEqual(earth.radii)
    expect(Ellipsoid.from(earth).radii).toEqual(earth.radii)
  })

  const height = fc.oneof(
    number(-500, 9000),
    number(-6.3e6, 0),
    magnitude(1e4, 4e8),
    fc.constant(0)
  )

  it('round trips below 1 µm from deep inside to the moon', () => {
    fc.assert(
      fc.property(longitude, latitude, height, (lon, lat, h) => {
        const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height: h })
        const place = earth.ecefToGeodetic(position)
        expect(Math.abs(place.height - h)).toBeLessThan(micrometre)
        expect(Math.abs(place.latitude - lat) * 1.1e5).toBeLessThan(
          micrometre * Math.max(1, 6.4e6 / (6.4e6 + h))
        )
        expect(earth.geodeticToECEF(place).distanceTo(position)).toBeLessThan(micrometre)
      }),
      runs
    )
  })

  const shapes: [string, Ellipsoid][] = [
    ['WGS84', earth],
    ['a sphere', new Ellipsoid(6371e3)],
    ['a prolate spheroid', new Ellipsoid(5e6, 5e6, 6e6)],
    ['three radii', new Ellipsoid(6.4e6, 6.1e6, 5.6e6)],
    ['smallest along X', new Ellipsoid(3e6, 5e6, 6e6)],
    ['very flat', new Ellipsoid(6e6, 6e6, 1e6)],
    ['1 m', new Ellipsoid(1, 0.9, 0.8)]
  ]

  it.each(shapes)('%s: any position round trips, even at the centre', (_, ellipsoid) => {
    const size = ellipsoid.maximumRadius
    const distance = fc.oneof(magnitude(1e-12, 10), number(0, 2), fc.constantFrom(0, 0.01))
    const along = fc.oneof(
      direction,
      fc.constantFrom(new Vector3(1, 0, 0), new Vector3(0, -1, 0), new Vector3(0, 0, 1)),
      direction.map(v => v.clone().setZ(0))
    )
    fc.assert(
      fc.property(along, distance, (v, d) => {
        const position = v.clone().multiplyScalar(d * size)
        const back = ellipsoid.geodeticToECEF(ellipsoid.ecefToGeodetic(position))
        expect(back.distanceTo(position)).toBeLessThan(micrometre)
        const foot = ellipsoid.footPoint(position)
        expect(foot.clone().divide(ellipsoid.radii).length()).toBeCloseTo(1, 13)
      }),
      runs
    )
  })

  it.each(shapes)('%s: no point of the surface is nearer than the foot point', (_, ellipsoid) => {
    fc.assert(
      fc.property(direction, number(0, 3), direction, (v, d, other) => {
        const position = v.clone().multiplyScalar(d * ellipsoid.maximumRadius)
        const nearest = ellipsoid.footPoint(position).distanceTo(position)
        const candidate = other.clone().multiply(ellipsoid.radii).distanceTo(position)
        expect(candidate).toBeGreaterThan(nearest - 1e-7)
      }),
      runs
    )
  })

  it('takes the place above the pole for the centre', () => {
    const place = earth.ecefToGeodetic(new Vector3())
    expect(place.latitude).toBe(90)
    expect(place.height).toBeCloseTo(-6356752.3142, 4)
  })
})

describe('frames', () => {
  it('has east, north and up at the origin of coordinates', () => {
    const { elements } = earth.eastNorthUpFrame(new Vector3(6378137, 0, 0))
    const expected = [0, 1, 0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 6378137, 0, 0, 1]
    expected.forEach((value, i) => expect(elements[i]).toBeCloseTo(value, 15))
  })

  it('is a rotation, and Y-up is the same with north at −Z', () => {
    fc.assert(
      fc.property(longitude, latitude, number(-500, 1e7), (lon, lat, height) => {
        const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const enu = earth.eastNorthUpFrame(position)
        const yUp = earth.localYUpFrame(position)
        expect(enu.determinant()).toBeCloseTo(1, 12)
        const fromYUp = new Matrix4().makeBasis(
          new Vector3(1, 0, 0),
          new Vector3(0, 0, 1),
          new Vector3(0, -1, 0)
        )
        const same = enu.clone().multiply(fromYUp)
        same.elements.forEach((value, i) => expect(yUp.elements[i]).toBeCloseTo(value, 12))
        const above = new Vector3(0, 25, 0).applyMatrix4(yUp)
        expect(earth.heightAt(above)).toBeCloseTo(height + 25, 6)
        const north = earth.ecefToGeodetic(new Vector3(0, 1, 0).applyMatrix4(enu)).latitude
        if (Math.abs(lat) < 89) expect(north).toBeGreaterThan(lat)
      }),
      runs
    )
  })

  it('has an east at the poles', () => {
    const frame = earth.eastNorthUpFrame(new Vector3(0, 0, 6.4e6))
    expect(new Vector3(1, 0, 0).transformDirection(frame)).toEqual(new Vector3(0, 1, 0))
    expect(frame.determinant()).toBe(1)
  })
})

describe('radii', () => {
  it('matches the published radii of curvature of WGS84', () => {
    const equator = new Vector3(earth.a, 0, 0)
    const pole = new Vector3(0, 0, earth.b)
    // NGA.STND.0036: polar radius of curvature; at the equator √(M N) = b.
    expect(earth.osculatingSphere(pole).radius).toBeCloseTo(6399593.6258, 4)
    expect(earth.osculatingSphere(equator).radius).toBeCloseTo(6356752.3142, 4)
    expect(earth.osculatingSphere(equator).center.x).toBeCloseTo(6378137 - 6356752.3142, 4)
  })

  it('knows the ground radius', () => {
    const at = (lat: number): number =>
      earth.localGroundRadius(earth.geodeticToECEF({ longitude: 7, latitude: lat, height: 5e5 }))
    expect(at(0)).toBeCloseTo(6378137, 6)
    expect(at(45)).toBeCloseTo(6367489.5439, 3)
    expect(at(90)).toBeCloseTo(6356752.3142, 4)
  })

  it('touches the surface at the foot point', () => {
    fc.assert(
      fc.property(longitude, latitude, (lon, lat) => {
        const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height: 1000 })
        const sphere = earth.osculatingSphere(position)
        expect(sphere.distanceToPoint(position)).toBeCloseTo(1000, 6)
        expect(earth.osculatingSphere(position, 6e6).radius).toBe(6e6)
      }),
      runs
    )
  })
})

describe('the map to a sphere', () => {
  it('takes the surface to radius a and back', () => {
    fc.assert(
      fc.property(longitude, latitude, direction, (lon, lat, v) => {
        const p = earth.geodeticToECEF({ longitude: lon, latitude: lat })
        const mapped = earth.toSphere(p)
        expect(mapped.length()).toBeCloseTo(6378137, 6)
        expect(earth.fromSphere(mapped).distanceTo(p)).toBeLessThan(1e-8)
        // (Sv)·(Sp) ∝ v·n: the horizon and the terminator are exact.
        const normal = earth.surfaceNormal(p)
        const support = p.dot(normal)
        expect(earth.toSphere(v).dot(mapped) / earth.a ** 2).toBeCloseTo(
          v.dot(normal) / support,
          13
        )
        const direct = earth.directionToSphere(v)
        expect(direct.length()).toBeCloseTo(1, 14)
        expect(earth.directionFromSphere(direct).distanceTo(v)).toBeLessThan(1e-15)
      }),
      runs
    )
  })

  it('keeps altitude within 0.34 %', () => {
    fc.assert(
      fc.property(longitude, latitude, magnitude(1, 1e6), (lon, lat, height) => {
        const p = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const mapped = earth.toSphere(p).length() - earth.a
        expect(Math.abs(mapped / height - 1)).toBeLessThan(0.0034)
      }),
      runs
    )
  })
})
