import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { Matrix4, Vector3 } from 'three'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { SphericalSpace } from '../../src/view/cpu/spherical'
import { viewpointScalars, LOWEST_VIEWPOINT } from '../../src/view/cpu/viewpoint'
import { cosine, number, runs } from '../arbitraries'

const earth = new AtmosphereParameters()

describe('viewpoint', () => {
  it('sees the horizon where geometry has it', () => {
    fc.assert(
      fc.property(number(-1e5, 6e7), cosine, (altitude, cosLight) => {
        const viewpoint = viewpointScalars(earth, altitude, cosLight)
        const height = Math.max(altitude, LOWEST_VIEWPOINT)
        const { bottomRadius } = earth
        // From afar the radius is what float32 has, and all else is the geometry of that radius.
        const exact = bottomRadius + height
        const radius = height > bottomRadius ? viewpoint.radius : exact
        expect(Math.abs(viewpoint.radius / exact - 1)).toBeLessThan(
          height > bottomRadius ? 2 ** -23 : 1e-15
        )
        expect(viewpoint.altitude).toBe(height)
        expect(viewpoint.sinHorizon).toBeCloseTo(bottomRadius / radius, 12)
        const above = height > bottomRadius ? radius - bottomRadius : height
        const cosHorizon = -Math.sqrt(above * (2 * bottomRadius + above)) / radius
        expect(viewpoint.toHorizon / (above * (2 * bottomRadius + above))).toBeCloseTo(1, 12)
        expect(Math.abs(viewpoint.cosHorizon - cosHorizon)).toBeLessThan(1e-9)
        expect(Object.values(viewpoint).every(Number.isFinite)).toBe(true)
        expect(viewpoint.belowScale).toBeGreaterThan(0)
        expect(viewpoint.aboveScale).toBeGreaterThan(0)
        expect(viewpoint.groundGrowth).toBeCloseTo(Math.exp(1 / viewpoint.groundStretch) - 1, 9)
        expect(viewpoint.skyGrowth).toBeCloseTo(Math.exp(1 / viewpoint.skyStretch) - 1, 9)
      }),
      runs
    )
  })
})

describe('spherical space', () => {
  it('makes the ellipsoid a sphere, whatever the world', () => {
    const space = new SphericalSpace()
    const ellipsoid = Ellipsoid.WGS84
    fc.assert(
      fc.property(
        number(-180, 180),
        number(-90, 90),
        number(1, 1e4),
        (longitude, latitude, unit) => {
          const ecef = ellipsoid.geodeticToECEF({ longitude, latitude })
          const world = new Matrix4().makeScale(unit, unit, unit)
          space.set(world, ellipsoid, 6e6)
          const mapped = space.position(ecef.clone().divideScalar(unit), new Vector3())
          expect(Math.abs(mapped.length() - 6e6)).toBeLessThan(0.01)
          const direction = space.direction(new Vector3(1, 2, 3), new Vector3())
          expect(direction.length()).toBeCloseTo(1, 12)
          const up = space.direction(ecef, new Vector3())
          expect(up.dot(mapped.normalize())).toBeCloseTo(1, 12)
        }
      ),
      runs
    )
  })
})
