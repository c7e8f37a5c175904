import {
  Ellipsoid,
  ellipsoidToSphere,
  offsetHeight,
  rayEllipsoid,
  raySphere,
  sphereEye,
  sphereScale
} from '@welkin/geo'
import { Vector3 } from 'three'
import { float, vec3 } from 'three/tsl'
import { offsetHeight as offsetHeightTwin } from '../../../packages/geo/test/twins/offsetHeight'
import { raySphere as raySphereTwin } from '../../../packages/geo/test/twins/rayEllipsoid'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const earth = Ellipsoid.WGS84
const radius = earth.a

/** Evenly spread numbers in [0, 1), the same in every run. */
const spread = (i: number, k: number): number =>
  (i * [0.6180339887, 0.7548776662, 0.5698402911][k]) % 1

const vector = ({ x, y, z }: Vector3) => vec3(x, y, z)

gpuTest('maps the ellipsoid to a sphere', async t => {
  const points = Array.from({ length: 300 }, (_, i) =>
    earth.geodeticToECEF({ longitude: 360 * spread(i, 0), latitude: 180 * spread(i, 1) - 90 })
  )
  const scale = vector(sphereScale(earth))
  const results = await t.evaluate(
    points.map(p => p.toArray()),
    input => ellipsoidToSphere(input.xyz, scale).length()
  )
  expectClose(
    points.map((_, i) => results[4 * i]),
    points.map(() => radius),
    { relative: 3e-7 }
  )
})

gpuTest('finds heights to centimetres near the eye', async t => {
  for (const eyeHeight of [2, 1e4, 4e5]) {
    const up = new Vector3(0.36, 0.48, 0.8)
    const inputs = Array.from({ length: 400 }, (_, i) => {
      const length = Math.exp(12 * spread(i, 0))
      const z = 2 * spread(i, 1) - 1
      const angle = 2 * Math.PI * spread(i, 2)
      const s = Math.sqrt(1 - z * z)
      return [s * Math.cos(angle) * length, s * Math.sin(angle) * length, z * length].map(
        Math.fround
      )
    })
    const results = await t.evaluate(inputs, input =>
      offsetHeight(input.xyz, vector(up), float(eyeHeight), float(radius))
    )
    const expected = inputs.map(([x, y, z]) =>
      offsetHeightTwin(new Vector3(x, y, z), up, eyeHeight, radius)
    )
    for (const [i, value] of expected.entries()) {
      const length = Math.hypot(...inputs[i])
      expectClose(
        results[4 * i],
        value,
        { absolute: 1e-3 + 3e-7 * (length + eyeHeight) },
        `eye ${eyeHeight} m`
      )
    }
  }
})

gpuTest('meets the sphere where float64 does', async t => {
  const inputs: number[][] = []
  for (const height of [2, 1e3, 1e4, 4e5, 2e7, -10, -1e5]) {
    const horizon = height > 0 ? -Math.sqrt(height * (2 * radius + height)) / (radius + height) : 1
    for (let i = 0; i < 60; ++i) {
      // Up to 0.1 % of the way to the horizon, where one digit of the cosine is kilometres.
      const cosine = -1 + (horizon + 1) * 0.999 * spread(i, 0)
      inputs.push([height, Math.fround(cosine)])
    }
    inputs.push([height, 1], [height, height > 0 ? horizon * 0.99 : 0.5])
  }
  const results = await t.evaluate(inputs, input => raySphere(input.x, float(radius), input.y))
  inputs.forEach(([height, cosView], i) => {
    const expected = raySphereTwin(height, radius, cosView)
    expectClose(results[4 * i], expected, { relative: 2e-3 }, `height ${height}, cos ${cosView}`)
  })
})

gpuTest('meets the ellipsoid where float64 does', async t => {
  const scale = vector(sphereScale(earth))
  for (const height of [2, 1e4, 2e7]) {
    const position = earth.geodeticToECEF({ longitude: 30, latitude: 50, height })
    const eye = sphereEye(earth, position)
    const frame = earth.eastNorthUpFrame(position)
    const views = Array.from({ length: 200 }, (_, i) => {
      const dip = 0.3 + 1.2 * spread(i, 0)
      const angle = 2 * Math.PI * spread(i, 1)
      const c = Math.cos(height > 1e6 ? 1.45 : dip)
      return new Vector3(
        c * Math.cos(angle),
        c * Math.sin(angle),
        -Math.sqrt(1 - c * c)
      ).transformDirection(frame)
    })
    const results = await t.evaluate(
      views.map(v => v.toArray()),
      input => rayEllipsoid(input.xyz, scale, vector(eye.up), float(eye.height), float(radius))
    )
    views.forEach((view, i) => {
      const expected = earth.intersectRayDistance(position, view) ?? NaN
      expectClose(results[4 * i], expected, { relative: 1e-5 }, `height ${height}`)
    })
  }
})
