import { Ellipsoid, offsetPoint } from '@welkin/geo'
import { Vector3 } from 'three'
import { float, vec3 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { offsetPoint as offsetPoint64 } from '../../../packages/geo/test/twins/offsetPoint'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const radius = Ellipsoid.WGS84.a

/** Evenly spread numbers in [0, 1), the same in every run. */
const spread = (i: number, k: number): number =>
  (i * [0.6180339887, 0.7548776662, 0.5698402911][k]) % 1

const vector = ({ x, y, z }: Vector3) => vec3(x, y, z)

gpuTest('finds heights to centimetres near the viewpoint', async t => {
  for (const viewHeight of [2, 1e4, 4e5]) {
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
    const point = (offset: Node<'vec3'>) =>
      offsetPoint(offset, vector(up), float(viewHeight), float(radius))
    const heights = await t.evaluate(inputs, input => point(input.xyz).height)
    const ups = await t.evaluate(inputs, input => point(input.xyz).up)
    for (const [i, [x, y, z]] of inputs.entries()) {
      const expected = offsetPoint64(new Vector3(x, y, z), up, viewHeight, radius)
      const length = Math.hypot(x, y, z)
      expectClose(
        heights[4 * i],
        expected.height,
        { absolute: 1e-3 + 3e-7 * (length + viewHeight) },
        `height from ${viewHeight} m`
      )
      expectClose(
        ups.slice(4 * i, 4 * i + 3),
        expected.up.toArray(),
        { absolute: 3e-7 },
        `zenith from ${viewHeight} m`
      )
    }
  }
})
