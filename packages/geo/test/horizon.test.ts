import fc from 'fast-check'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  Ellipsoid,
  horizonDip,
  horizonDistance,
  tangentLimbDistance,
  visibleDistance
} from '@welkin/geo'
import { latitude, longitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84
const radius = 6371e3
const ellipsoid = new Ellipsoid(radius)

const above = (height: number, on = earth): Vector3 =>
  on.geodeticToECEF({ longitude: 20, latitude: 40, height })

describe('on a sphere', () => {
  it('has the distance √(h (2R + h)) and the dip acos(R / (R + h))', () => {
    fc.assert(
      fc.property(
        longitude,
        latitude,
        magnitude(0.1, 1e9),
        number(-180, 540),
        (lon, lat, h, azimuthDegrees) => {
          const viewpoint = ellipsoid.geodeticToECEF({ longitude: lon, latitude: lat, height: h })
          const options = { ellipsoid, azimuthDegrees }
          const distance = Math.sqrt(h * (2 * radius + h))
          expect(horizonDistance(viewpoint, options) / distance).toBeCloseTo(1, 7)
          expect(horizonDip(viewpoint, options)).toBeCloseTo(Math.atan(distance / radius), 7)
          const top = radius + 9000
          const beyond = Math.sqrt(top * top - radius * radius)
          expect(visibleDistance(viewpoint, 9000, 0, options) / (distance + beyond)).toBeCloseTo(
            1,
            7
          )
        }
      ),
      runs
    )
  })

  it('has limbs at other heights', () => {
    const viewpoint = above(400e3, ellipsoid)
    const to = (height: number): number => Math.sqrt((radius + 400e3) ** 2 - (radius + height) ** 2)
    expect(tangentLimbDistance(viewpoint, 60e3, { ellipsoid })).toBeCloseTo(to(60e3), 3)
    expect(tangentLimbDistance(viewpoint, -500, { ellipsoid })).toBeCloseTo(to(-500), 3)
    expect(tangentLimbDistance(viewpoint, 500e3, { ellipsoid })).toBe(0)
  })
})

describe('on the Earth', () => {
  it('matches familiar figures', () => {
    // 3.57 km √h: Young, "Distance to the Horizon"; the space station; the geostationary orbit.
    expect(horizonDistance(above(1.7)) / 1000).toBeCloseTo(4.66, 1)
    expect(horizonDistance(above(100)) / 1000).toBeCloseTo(35.7, 1)
    expect(horizonDistance(above(8849)) / 1000).toBeCloseTo(336, -0.5)
    expect((horizonDip(above(400e3)) * 180) / Math.PI).toBeCloseTo(19.8, 0)
    const geostationary = new Vector3(42164.2e3, 0, 0)
    const distance = horizonDistance(geostationary, { azimuthDegrees: 90 })
    expect(distance / 1000).toBeCloseTo(Math.sqrt(42164.2 ** 2 - 6378.137 ** 2), 3)
  })

  it('touches the ellipsoid exactly, in every direction', () => {
    fc.assert(
      fc.property(
        longitude,
        latitude,
        magnitude(1, 1e9),
        number(0, 360),
        (lon, lat, h, azimuth) => {
          const viewpoint = earth.geodeticToECEF({ longitude: lon, latitude: lat, height: h })
          const options = { azimuthDegrees: azimuth }
          const dip = horizonDip(viewpoint, options)
          const angle = (azimuth * Math.PI) / 180
          const viewDirection = new Vector3(
            Math.sin(angle) * Math.cos(dip),
            Math.cos(angle) * Math.cos(dip),
            -Math.sin(dip)
          ).transformDirection(earth.eastNorthUpFrame(viewpoint))
          const touch = viewpoint
            .clone()
            .addScaledVector(viewDirection, horizonDistance(viewpoint, options))
          expect(Math.abs(earth.heightAt(touch))).toBeLessThan(1e-6 + 1e-13 * h)
          expect(Math.abs(viewDirection.dot(earth.surfaceNormal(touch)))).toBeLessThan(1e-6)
        }
      ),
      runs
    )
  })

  it('is nearer where the Earth bends more', () => {
    const viewpoint = earth.geodeticToECEF({ longitude: 0, latitude: 0, height: 100 })
    const north = horizonDistance(viewpoint, { azimuthDegrees: 0 })
    const east = horizonDistance(viewpoint, { azimuthDegrees: 90 })
    // √(M / N) at the equator = b / a.
    expect(north / east).toBeCloseTo(6356752.3142 / 6378137, 5)
  })

  it('is 0 on the ground and below it', () => {
    expect(horizonDistance(above(-1))).toBe(0)
    expect(horizonDip(above(-1))).toBe(0)
    expect(visibleDistance(above(-100), 0)).toBeCloseTo(Math.sqrt(2 * 6376e3 * 100), -3)
  })
})
