import { CloudLightTable, cloudPreset, cloudQualities, type CloudQuality } from '@welkin/clouds'
import { float, vec3, vec4 } from 'three/tsl'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { marchClouds } from '../../../packages/clouds/src/march/tsl/march'
import { random } from '../harness/atmosphere'
import { cloudScene, mean } from '../harness/cloud-scene'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

const { high, medium, low } = cloudQualities

/** Steps of an eighth of the length of `high`. */
const fine: CloudQuality = {
  ...high,
  steps: 1024,
  stepGrowth: high.stepGrowth / 8,
  shortestStep: high.shortestStep / 8,
  depthStep: high.depthStep / 8,
  layerSteps: high.layerSteps * 8
}

/** Share of the likely distances that the fine march goes by: see `CloudField.skipping`. */
const FINE_SKIPPING = 0.25

gpuTest(
  'rays find the heads of towers far away',
  async t => {
    const layers = cloudPreset('congestus')
    const scene = await cloudScene(t, layers, { longitude: 139.7, latitude: 35.7, height: 2 })
    const { field } = scene
    field.pixelAngle.value = 9e-4
    const light = new CloudLightTable()
    light.bake()
    field.depthScale.value = light.nodes.depthScale.value
    scene.update()
    const next = random(5)
    /** Azimuth and elevation [rad], and the jitter. */
    const rays = Array.from({ length: 600 }, () => [
      2 * Math.PI * next(),
      (2 + 13 * next()) * (Math.PI / 180),
      next(),
      0
    ])
    const quality = new QualityUniforms()
    const { up } = field.view
    const opacities = async (of: CloudQuality, skipping: number): Promise<number[]> => {
      quality.set(of)
      field.skipping.value = skipping
      const found = await evaluateOnGpu(scene.renderer, rays, ({ x, y, z }) => {
        const ahead = up.yzx.cross(up).normalize().toConst()
        const aside = up.cross(ahead).toConst()
        const level = ahead.mul(x.cos()).add(aside.mul(x.sin()))
        const direction = level.mul(y.cos()).add(up.mul(y.sin())).normalize().toConst()
        const ray = { direction, end: float(1e5), jitter: z }
        const { transmittance } = marchClouds({ field, light: light.nodes, quality }, ray)
        return vec4(transmittance.oneMinus())
      })
      return rays.map((_, i) => found[4 * i])
    }
    const expected = await opacities(fine, FINE_SKIPPING)
    for (const [name, of, limit] of [
      ['high', high, 0.03],
      ['medium', medium, 0.045]
    ] as const) {
      const got = await opacities(of, 1)
      const missed = mean(got.map((opacity, i) => Math.max(expected[i] - opacity, 0)))
      const more = mean(got.map((opacity, i) => Math.max(opacity - expected[i], 0)))
      t.note(`${name}: cover ${mean(expected).toFixed(3)}, missed ${missed}, more ${more}`)
      expectTrue(missed < limit, `${name}: rays miss ${missed} of the sky`)
      expectTrue(more < limit, `${name}: rays meet clouds in ${more} of the sky that is clear`)
    }
    light.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'rays find the face of a tower behind small clouds whose layer they leave',
  async t => {
    const layers = cloudPreset('cumulonimbus')
    const scene = await cloudScene(t, layers, { longitude: 139.853, latitude: 35.845, height: 600 })
    const { field } = scene
    field.pixelAngle.value = 3.9e-3
    scene.update(300)
    const next = random(7)
    /** Azimuth from north and elevation [rad], to the tower's foot, and the jitter. */
    const rays = Array.from({ length: 600 }, () => [
      (15 + 10 * next()) * (Math.PI / 180),
      (4.5 + 2.7 * next()) * (Math.PI / 180),
      next(),
      0
    ])
    const quality = new QualityUniforms()
    const light = new CloudLightTable()
    light.bake()
    field.depthScale.value = light.nodes.depthScale.value
    const { up } = field.view
    const distances = async (of: CloudQuality, skipping: number): Promise<number[]> => {
      quality.set(of)
      field.skipping.value = skipping
      const found = await evaluateOnGpu(scene.renderer, rays, ({ x, y, z }) => {
        const east = vec3(0, 0, 1).cross(up).normalize().toConst()
        const north = up.cross(east).toConst()
        const level = north.mul(x.cos()).add(east.mul(x.sin()))
        const direction = level.mul(y.cos()).add(up.mul(y.sin())).normalize().toConst()
        const ray = { direction, end: float(6e4), jitter: z }
        const { distance, transmittance } = marchClouds({ field, light: light.nodes, quality }, ray)
        return vec4(distance, transmittance, 0, 0)
      })
      return rays.map((_, i) => (found[4 * i + 1] < 0.5 ? found[4 * i] : 6e4))
    }
    const expected = await distances(fine, FINE_SKIPPING)
    for (const [name, of] of Object.entries({ medium, low })) {
      const got = await distances(of, 1)
      const late = mean(got.map((distance, i) => (distance > expected[i] + 300 ? 1 : 0)))
      t.note(`${name}: ${late} of the rays are late`)
      expectTrue(late < 0.02, `${name}: ${late} of the rays jump into the tower, or over it`)
    }
    light.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'rays from above find small clouds below the layer of storms',
  async t => {
    const layers = cloudPreset('cumulonimbus')
    const place = { longitude: 139.571, latitude: 35.995, height: 7000 }
    const scene = await cloudScene(t, layers, place)
    const { field } = scene
    field.pixelAngle.value = 9.6e-4
    const light = new CloudLightTable()
    light.bake()
    field.depthScale.value = light.nodes.depthScale.value
    scene.update(300)
    const next = random(7)
    /** Azimuth from north and elevation [rad], and the jitter. */
    const rays = Array.from({ length: 250 }, () => [
      (25 * next() - 22) * (Math.PI / 180),
      (8 * next() - 26) * (Math.PI / 180),
      next(),
      0
    ])
    const quality = new QualityUniforms()
    const { up } = field.view
    const opacities = async (of: CloudQuality, skipping: number): Promise<number[]> => {
      quality.set(of)
      field.skipping.value = skipping
      const found = await evaluateOnGpu(scene.renderer, rays, ({ x, y, z }) => {
        const east = vec3(0, 0, 1).cross(up).normalize().toConst()
        const north = up.cross(east).toConst()
        const level = north.mul(x.cos()).add(east.mul(x.sin()))
        const direction = level.mul(y.cos()).add(up.mul(y.sin())).normalize().toConst()
        const ray = { direction, end: float(3e4), jitter: z }
        return vec4(
          marchClouds({ field, light: light.nodes, quality }, ray).transmittance.oneMinus()
        )
      })
      return rays.map((_, i) => found[4 * i])
    }
    const expected = await opacities(fine, FINE_SKIPPING)
    const got = await opacities(high, 1)
    const missed = mean(got.map((opacity, i) => Math.max(expected[i] - opacity, 0)))
    const more = mean(got.map((opacity, i) => Math.max(opacity - expected[i], 0)))
    t.note(`cover ${mean(expected).toFixed(3)}, missed ${missed}, more ${more}`)
    expectTrue(mean(expected) > 0.4, 'there are clouds')
    expectTrue(missed < 0.05, `rays miss ${missed} of the sky`)
    expectTrue(more < 0.05, `rays meet clouds in ${more} of the sky that is clear`)
    light.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)
