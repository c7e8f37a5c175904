import fc from 'fast-check'
import { Vector3 } from 'three'
import { float, vec3 } from 'three/tsl'
import { describe, expect, it } from 'vitest'
import {
  Ellipsoid,
  ellipsoidToSphere,
  offsetHeight,
  rayEllipsoid,
  raySphere,
  sphereEye,
  sphereScale
} from '@welkin/geo'
import { offsetHeight as offsetHeightTwin } from './twins/offsetHeight'
import { raySphere as raySphereTwin } from './twins/rayEllipsoid'
import { direction, latitude, longitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84

describe('shader functions', () => {
  it('builds named calls', () => {
    const v = vec3(1, 0, 0)
    const h = float(2)
    const calls = {
      ellipsoidToSphere: ellipsoidToSphere(v, v),
      offsetHeight: offsetHeight(v, v, h, h),
      raySphere: raySphere(h, h, h),
      rayEllipsoid: rayEllipsoid(v, v, v, h, h)
    }
    for (const [name, call] of Object.entries(calls)) {
      const { layout } = (call as unknown as { shaderNode: { layout: { name: string } } })
        .shaderNode
      // A name of its own keeps generated shaders independent of import order.
      expect(layout.name).toBe(name)
    }
  })
})

describe('what they are given', () => {
  it('scales the ellipsoid to a sphere', () => {
    const scale = sphereScale(earth)
    expect(scale.x).toBe(1)
    expect(scale.z).toBeCloseTo(6378137 / 6356752.3142, 10)
  })

  it('finds the same ground through the mapped space as on the ellipsoid', () => {
    fc.assert(
      fc.property(longitude, latitude, magnitude(0.1, 1e8), direction, (lon, lat, height, v) => {
        const position = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const eye = sphereEye(earth, position)
        const mapped = v.clone().multiply(sphereScale(earth))
        const stretch = mapped.length()
        const cosView = Math.min(Math.max(mapped.dot(eye.up) / stretch, -1), 1)
        const distance = raySphereTwin(eye.height, earth.a, cosView)
        const exact = earth.intersectRayDistance(position, v)
        // At grazing incidence the last digits decide.
        const miss = Math.sqrt(1 - cosView * cosView) * (1 + eye.height / earth.a)
        if (Math.abs(miss - 1) < 1e-9) return
        if (exact === null) expect(distance).toBe(-1)
        else expect(distance / stretch / exact).toBeCloseTo(1, 5)
      }),
      runs
    )
  })

  it('finds the height of a point at an offset', () => {
    fc.assert(
      fc.property(latitude, number(0, 1e5), direction, magnitude(1, 1e6), (lat, height, v, d) => {
        const position = earth.geodeticToECEF({ longitude: 5, latitude: lat, height })
        const eye = sphereEye(earth, position)
        const offset = v.clone().multiplyScalar(d)
        const mapped = earth.toSphere(offset)
        const point = earth.toSphere(position.clone().add(offset))
        const expected = point.length() - earth.a
        expect(offsetHeightTwin(mapped, eye.up, eye.height, earth.a)).toBeCloseTo(expected, 6)
        // The form that the shader uses, in float64.
        const eyeRadius = earth.a + eye.height
        const gain = 2 * eyeRadius * mapped.dot(eye.up) + mapped.lengthSq()
        const shader = eye.height + gain / (Math.sqrt(eyeRadius ** 2 + gain) + eyeRadius)
        expect(shader).toBeCloseTo(expected, 6)
      }),
      runs
    )
    expect(sphereEye(earth, new Vector3(0, 0, 2 * earth.b)).height).toBeCloseTo(earth.a, 6)
  })
})
