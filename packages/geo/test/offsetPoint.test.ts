import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { Ellipsoid } from '@welkin/geo'
import { offsetPoint } from './twins/offsetPoint'
import { direction, latitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84

describe('offsetPoint', () => {
  it('places a point at an offset', () => {
    fc.assert(
      fc.property(latitude, number(0, 1e5), direction, magnitude(1, 1e6), (lat, height, v, d) => {
        const position = earth.geodeticToECEF({ longitude: 5, latitude: lat, height })
        const up = earth.toSphere(position)
        const viewHeight = up.length() - earth.a
        up.normalize()
        const offset = v.clone().multiplyScalar(d)
        const mapped = earth.toSphere(offset)
        const point = earth.toSphere(position.clone().add(offset))
        const expected = point.length() - earth.a
        const twin = offsetPoint(mapped, up, viewHeight, earth.a)
        expect(twin.height).toBeCloseTo(expected, 6)
        expect(twin.radius).toBeCloseTo(point.length(), 6)
        expect(twin.up.distanceTo(point.normalize())).toBeLessThan(1e-12)
        // The form that the shader uses, in float64.
        const start = earth.a + viewHeight
        const gain = 2 * start * mapped.dot(up) + mapped.lengthSq()
        const shader = viewHeight + gain / (Math.sqrt(start ** 2 + gain) + start)
        expect(shader).toBeCloseTo(expected, 6)
      }),
      runs
    )
  })
})
