import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { Matrix4, Vector3 } from 'three'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import {
  linearSRGBColumns,
  spectralToLinearSRGB,
  whiteBalancedColumns,
  xyzToLinearSRGB
} from '../../src/air/cpu/color'
import {
  diffuseColumn,
  diffuseColumnCosine,
  diffuseTexel
} from '../../src/diffuseLight/cpu/diffuseLight'
import { viewpointScalars, LOWEST_VIEWPOINT } from '../../src/view/cpu/viewpoint'
import { skyIrradiance } from '../../src/diffuseLight/cpu/skyIrradiance'
import { SphericalSpace } from '../../src/view/cpu/spherical'
import { DIFFUSE_SIZE, DIFFUSE_TILES, RADIANCE_SCALE } from '../../src/tables/tableSizes'
import { cosine, number, runs } from '../arbitraries'

const earth = new AtmosphereParameters()

describe('sky irradiance', () => {
  it('under a uniform sky is π times its radiance', () => {
    const [columns, rows] = DIFFUSE_SIZE
    const radiance = 0.3
    const values = new Float32Array(4 * columns * rows * DIFFUSE_TILES)
    for (let tile = 0; tile < DIFFUSE_TILES; tile++) {
      const value = tile === 0 ? Math.sqrt(4 * Math.PI) : tile >= 6 ? Math.PI : 0
      for (let row = 0; row < rows; row++) {
        const [first, end] = [0, columns].map(column => 4 * diffuseTexel(tile, column, row))
        values.fill(value * radiance * RADIANCE_SCALE, first, end)
      }
    }
    const data = { values }
    fc.assert(
      fc.property(number(0, 60_000), cosine, cosine, cosine, (altitude, normal, sun, normalSun) => {
        for (const value of skyIrradiance(earth, data, altitude, normal, sun, normalSun)) {
          expect(value / (Math.PI * radiance)).toBeCloseTo(1, 5)
        }
      }),
      runs
    )
  })

  it('finds a column by its cosine', () => {
    for (let column = 0; column < DIFFUSE_SIZE[0]; column++) {
      const back = diffuseColumn(diffuseColumnCosine(column)) * (DIFFUSE_SIZE[0] - 1)
      expect(back).toBeCloseTo(column, 9)
    }
  })
})

describe('colour', () => {
  it('shows D65 as white', () => {
    for (const value of xyzToLinearSRGB([0.95047, 1, 1.08883])) expect(value).toBeCloseTo(1, 3)
  })

  it('adds columns up to sunlight', () => {
    const columns = linearSRGBColumns(earth, 2)
    const sun = spectralToLinearSRGB(earth, earth.solarIrradiance)
    const balanced = whiteBalancedColumns(earth)
    for (const row of [0, 1, 2] as const) {
      const sum = columns.reduce((total, column) => total + column[row], 0)
      expect(sum / sun[row]).toBeCloseTo(2, 9)
      expect(balanced.reduce((total, column) => total + column[row], 0)).toBeCloseTo(1, 12)
    }
    const luminance = 0.2126 * sun[0] + 0.7152 * sun[1] + 0.0722 * sun[2]
    expect(Math.abs(luminance / 132_000 - 1)).toBeLessThan(0.02)
  })

  it('balances a white of nothing without dividing by zero', () => {
    const dark = new AtmosphereParameters({ solarIrradiance: [0, 0, 0, 0] })
    for (const column of whiteBalancedColumns(dark))
      expect(column.every(Number.isFinite)).toBe(true)
  })
})

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
