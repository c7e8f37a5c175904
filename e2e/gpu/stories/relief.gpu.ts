import { float, texture, vec3, vec4 } from 'three/tsl'
import { createGroundNoise } from '../../../stories/src/valley/groundNoise'
import { finestAt, groundHeight } from '../../../stories/src/valley/ground'
import { coarseNoise } from '../../../stories/src/valley/groundMaterial'
import { PatchMap } from '../../../stories/src/valley/PatchMap'
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

/** Blur of noise as coarse as the map's texels. */
const TEXEL_LEVEL = 1.5

/** Half width of the land that the map holds on all sides [m]. */
const MAPPED = 9000

gpuTest("the valley's map of coarse noise has it where it is", async t => {
  const renderer = await t.createRenderer()
  const draw = random(4)
  const picture = createGroundNoise()
  const noise = coarseNoise(at => texture(picture, at).level(float(TEXEL_LEVEL)).r.sub(0.5).mul(2))
  const map = new PatchMap(noise)
  const inputs = Array.from({ length: 200 }, () => {
    const [x, z] = [0, 1].map(() => Math.fround(MAPPED * (2 * draw() - 1)))
    return [x, z, 0, 0]
  })
  const results = await evaluateOnGpu(renderer, inputs, input => {
    const place = vec3(input.x, 0, input.y)
    return vec4(map.sample(place, float(0)), noise(place))
  })
  for (const [i, name] of ['broad', 'patches'].entries()) {
    const pairs = inputs.map((_, row) => [results[4 * row + i], results[4 * row + 2 + i]])
    const apart = Math.hypot(...pairs.map(([found, right]) => found - right))
    const share = apart / Math.hypot(...pairs.map(([, right]) => right))
    t.note(`${name}: ${(100 * share).toFixed(1)} % of the noise is missed`)
    expectTrue(share < 0.25, `${name}: ${share}`)
  }
  map.dispose()
  picture.dispose()
})
