import { cloudPreset } from '@welkin/clouds'
import { float, int, vec2, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { layerAt } from '../../../packages/clouds/src/density/tsl/layer'
import type { CloudSample } from '../../../packages/clouds/src/density/tsl/sample'
import {
  extinctionsNearby,
  sampleLayerPair,
  weatherCacheAt
} from '../../../packages/clouds/src/density/tsl/sampler'
import { samplePair } from '../../../packages/clouds/src/density/tsl/samplePair'
import { addPair, seenClouds, seenState } from '../../../packages/clouds/src/march/tsl/seenPoints'
import { cloudExtinction } from '../harness/cloud-extinction'
import { altitudeIn, cloudScene, offsets } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** Rounding may differ between shaders: of the densest cloud's extinction [1/m]. */
const TOLERANCE = 1e-5

gpuTest(
  'gives pixels, shadows and light the same clouds',
  async t => {
    for (const name of ['fairWeather', 'cumulonimbus', 'mixed'] as const) {
      const layers = cloudPreset(name)
      for (const layer of layers) layer.set({ coverage: 0.7 })
      const scene = await cloudScene(t, layers, { longitude: 20, latitude: 45 })
      const { field } = scene
      const inputs = offsets(scene.viewpoint, 1024, 20_000, 9, altitudeIn(layers))
      const evaluate = (value: (sample: CloudSample) => Node<'vec4'>): Promise<Float32Array> =>
        evaluateOnGpu(scene.renderer, inputs, input => {
          const offset = input.xyz.toConst() as unknown as Node<'vec3'>
          const { altitude, up } = field.view.localCoordinates(offset)
          return value({ offset, altitude, up, distance: input.w })
        })
      const range = { first: int(0), last: int(layers.length) }
      const pairAt = (sample: CloudSample) =>
        samplePair(field, undefined, vec4(0).toVar(), sample, float(0), sample.up, range)
      const pixels = await evaluate(sample => {
        const { extinction, likelyDistance } = pairAt(sample)
        return vec4(cloudExtinction(field, sample, true), extinction, likelyDistance)
      })
      let [cloudy, clear] = [0, 0]
      inputs.forEach((_, i) => {
        const [expected, first, second, likelyDistance] = pixels.subarray(4 * i, 4 * i + 4)
        for (const got of [first, second]) {
          expectTrue(Math.abs(got - expected) < TOLERANCE, `${name}: ${got} for ${expected}`)
        }
        expectTrue(likelyDistance >= 0, `${name}: a likely distance of ${likelyDistance}`)
        expectTrue(expected === 0 || likelyDistance === 0, `${name}: ${likelyDistance} m in cloud`)
        if (likelyDistance > 0) clear++
        if (expected > 0) cloudy++
      })
      t.note(
        `${name}: ${cloudy} of ${inputs.length} places are in cloud, ${clear} know of none near`
      )
      expectTrue(cloudy > 100, `${name}: only ${cloudy} cloudy places`)
      expectTrue(clear > 100, `${name}: only ${clear} places have a distance to clouds`)
      if (layers.length === 1) {
        const coarse = await evaluate(sample => {
          const { extinction } = pairAt(sample)
          const weather = weatherCacheAt(field, sample, range)
          const layer = layerAt(field, int(0))
          const shadow = sampleLayerPair(field, layer, sample, [sample, sample]).x
          const [, light] = extinctionsNearby(field, weather, [sample, sample])
          return vec4(cloudExtinction(field, sample, false), shadow, light, extinction.x)
        })
        let lit = 0
        inputs.forEach((_, i) => {
          const [expected, shadow, light, found] = coarse.subarray(4 * i, 4 * i + 4)
          expectTrue(Math.abs(shadow - expected) < TOLERANCE, `shadow: ${shadow} for ${expected}`)
          // There is weather to keep where there is cloud.
          if (found === 0) return
          lit++
          expectTrue(Math.abs(light - expected) < TOLERANCE, `light: ${light} for ${expected}`)
        })
        expectTrue(lit > 100, `only ${lit} lit places`)
      }
      scene.dispose()
    }
  },
  // `clouds/density` holds the sampler to its twin on both.
  { backends: ['webgpu'] }
)

gpuTest('clouds too thin to be seen do not move the points that a ray sees', async t => {
  // Optical depths of two pairs of steps, and where they begin.
  const [distance] = await t.evaluate([[1e-9, 0.5, 100, 200]], input => {
    const state = seenState()
    addPair(state, vec2(input.x), [input.z, input.z.add(1)], vec2(1))
    addPair(state, vec2(input.y), [input.w, input.w.add(2)], vec2(2))
    return seenClouds(state, float(1)).points.distances
  })
  const share = Math.exp(-0.5) / (1 + Math.exp(-0.5))
  const aside = 2 * meanInStep(0.5)
  expectTrue(Math.abs(distance - (200 + 2 * share + aside)) < 1e-3, `they are at ${distance} m`)
})

/** Mean place where the light of a step of an optical depth comes from, from its middle on [lengths of the step]: by sums. */
function meanInStep(depth: number): number {
  const parts = 10_000
  let [sum, all] = [0, 0]
  for (let i = 0; i < parts; i++) {
    const t = (i + 0.5) / parts
    sum += (t - 0.5) * Math.exp(-depth * t)
    all += Math.exp(-depth * t)
  }
  return sum / all
}

gpuTest('dense steps are seen where they begin, thin ones in their middle', async t => {
  const depths = [1e-4, 0.02, 0.3, 2, 40]
  const length = 10
  const found = await t.evaluate(
    depths.map(depth => [depth, 0, 0, 0] as const),
    input => {
      const state = seenState()
      addPair(state, vec2(input.x, 0), [float(1005), float(1015)], vec2(10))
      return seenClouds(state, float(1)).points.distances
    }
  )
  depths.forEach((depth, i) => {
    const expected = 1005 + length * meanInStep(depth)
    expectTrue(Math.abs(found[4 * i] - expected) < 0.02, `depth ${depth}: ${found[4 * i]} m`)
  })
})
