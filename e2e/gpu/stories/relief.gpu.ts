import { vec4 } from 'three/tsl'
import { finestAt, groundHeight } from '../../../stories/src/valley/ground'
import { flatHeight } from '../../../stories/src/valley/relief'
import { random } from '../harness/atmosphere'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Half width of the land that is compared, and radius of the planet away from which it bends [m]. */
const REACH = 12_000
const RADIUS = 6_371_000

gpuTest("the valley's land is lit by slopes of the land that one stands on", async t => {
  const renderer = await t.createRenderer()
  const draw = random(3)
  const inputs = Array.from({ length: 300 }, () => {
    const [x, z] = [0, 1].map(() => Math.fround(REACH * (2 * draw() - 1)))
    return [x, z, Math.fround(finestAt(x, z)), 0]
  })
  const results = await evaluateOnGpu(renderer, inputs, input =>
    vec4(flatHeight(input.xy, input.z))
  )
  const expected = inputs.map(([x, z]) => groundHeight(x, z) + (x * x + z * z) / (2 * RADIUS))
  const found = inputs.map((_, i) => results[4 * i])
  const [lowest, highest] = [Math.min(...expected), Math.max(...expected)]
  t.note(`heights from ${lowest.toFixed(0)} to ${highest.toFixed(0)} m`)
  expectTrue(highest - lowest > 1000, 'the land is flat')
  expectClose(found, expected, { absolute: 0.5 }, 'height [m]')
})
