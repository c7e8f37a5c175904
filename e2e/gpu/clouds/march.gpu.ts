import { CloudLightTable, cloudPreset, cloudQualities, type CloudQuality } from '@welkin/clouds'
import { vec3, vec4 } from 'three/tsl'
import { FrameUniforms } from '../../../packages/clouds/src/march/FrameUniforms'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { compiledByKinds } from '../../../packages/clouds/src/density/kinds'
import { marchClouds } from '../../../packages/clouds/src/march/tsl/march'
import { marchedPixel } from '../../../packages/clouds/src/march/tsl/marchedPixel'
import type { FrameInputs } from '../../../packages/clouds/src/march/tsl/viewRay'
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

/** A ray's opacity, and the distance of its clouds; `end` where less than half of it is cloud [m]. */
interface Met {
  readonly opacity: number
  readonly distance: number
}

type Scene = Awaited<ReturnType<typeof cloudScene>>

/**
 * Marches rays through a scene's clouds.
 *
 * @param rays - Azimuth from north and elevation [rad], and the jitter.
 * @param end - Distance at which they end [m].
 */
function marcher(
  { renderer, field }: Scene,
  rays: readonly [azimuth: number, elevation: number, jitter: number][],
  end: number
): { march: (of: CloudQuality, skipping?: number) => Promise<Met[]>; dispose: () => void } {
  const light = new CloudLightTable()
  light.bake()
  field.depthScale.value = light.nodes.depthScale.value
  const quality = new QualityUniforms()
  const { up } = field.view
  const inputs = rays.map(ray => [...ray, end])
  // As for a camera: it compiles a tenth as long.
  const compiled = compiledByKinds(field)
  return {
    async march(of, skipping = 1) {
      quality.set(of)
      field.skipping.value = skipping
      const found = await evaluateOnGpu(renderer, inputs, ({ x, y, z, w }) => {
        const east = vec3(0, 0, 1).cross(up).normalize().toConst()
        const north = up.cross(east).toConst()
        const level = north.mul(x.cos()).add(east.mul(x.sin()))
        const direction = level.mul(y.cos()).add(up.mul(y.sin())).normalize().toConst()
        const ray = { direction, end: w, jitter: z }
        const { distance, transmittance } = marchClouds(
          { field: compiled, light: light.nodes, quality },
          ray
        )
        return vec4(distance, transmittance.oneMinus(), 0, 0)
      })
      return rays.map((_, i) => {
        const opacity = found[4 * i + 1]
        return { opacity, distance: opacity > 0.5 ? found[4 * i] : end }
      })
    },
    dispose: () => light.dispose()
  }
}

/** Means over rays of the opacity that they have too little of, and too much. */
function errorsOf(got: readonly Met[], expected: readonly Met[]): { missed: number; more: number } {
  const over = got.map(({ opacity }, i) => opacity - expected[i].opacity)
  return {
    missed: mean(over.map(each => Math.max(-each, 0))),
    more: mean(over.map(each => Math.max(each, 0)))
  }
}

/** Rays at random between azimuths from north and elevations [°]. */
const raysBetween = (
  count: number,
  seed: number,
  [west, east]: readonly [number, number],
  [low, high]: readonly [number, number]
): [number, number, number][] => {
  const next = random(seed)
  const between = (from: number, to: number): number =>
    ((from + (to - from) * next()) * Math.PI) / 180
  return Array.from({ length: count }, () => [between(west, east), between(low, high), next()])
}

gpuTest(
  'rays find the heads of towers far away',
  async t => {
    const layers = cloudPreset('congestus')
    const scene = await cloudScene(t, layers, { longitude: 139.7, latitude: 35.7, height: 2 })
    scene.field.pixelAngle.value = 9e-4
    scene.update()
    const rays = marcher(scene, raysBetween(600, 5, [0, 360], [2, 15]), 1e5)
    const expected = await rays.march(fine, FINE_SKIPPING)
    for (const [name, of, limit] of [
      ['high', high, 0.03],
      ['medium', medium, 0.045]
    ] as const) {
      const { missed, more } = errorsOf(await rays.march(of), expected)
      t.note(`${name}: missed ${missed}, more ${more}`)
      expectTrue(missed < limit, `${name}: rays miss ${missed} of the sky`)
      expectTrue(more < limit, `${name}: rays meet clouds in ${more} of the sky that is clear`)
    }
    rays.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'rays find the face of a tower behind small clouds whose layer they leave, and from above small clouds below its own',
  async t => {
    const layers = cloudPreset('cumulonimbus')
    const scene = await cloudScene(t, layers, { longitude: 139.853, latitude: 35.845, height: 600 })
    const { atmosphere, pixelAngle } = scene.field
    pixelAngle.value = 3.9e-3
    scene.update(300)
    // To the tower's foot.
    const rays = marcher(scene, raysBetween(400, 7, [15, 25], [4.5, 7.2]), 6e4)
    const expected = await rays.march(fine, FINE_SKIPPING)
    for (const [name, of] of Object.entries({ medium, low })) {
      const got = await rays.march(of)
      const late = mean(
        got.map(({ distance }, i) => (distance > expected[i].distance + 300 ? 1 : 0))
      )
      t.note(`${name}: ${late} of the rays are late`)
      expectTrue(late < 0.02, `${name}: ${late} of the rays jump into the tower, or over it`)
    }
    rays.dispose()

    // With the same shader.
    atmosphere.place({ longitude: 139.571, latitude: 35.995, height: 7000 })
    pixelAngle.value = 9.6e-4
    scene.update(300)
    const above = marcher(scene, raysBetween(200, 7, [-22, 3], [-26, -18]), 3e4)
    const seen = await above.march(fine, FINE_SKIPPING)
    const cover = mean(seen.map(({ opacity }) => opacity))
    const { missed, more } = errorsOf(await above.march(high), seen)
    t.note(`cover ${cover.toFixed(3)}, missed ${missed}, more ${more}`)
    expectTrue(cover > 0.4, 'there are clouds')
    expectTrue(missed < 0.05, `rays miss ${missed} of the sky`)
    expectTrue(more < 0.05, `rays meet clouds in ${more} of the sky that is clear`)
    above.dispose()
    scene.dispose()
  },
  { backends: ['webgpu'] }
)

/** Edge of the picture whose rays' noise is looked at [pixels]. */
const NOISE_SIZE = 64

gpuTest('noise of rays is uniform, even over few pixels, and has no weave', async t => {
  const renderer = await t.createRenderer()
  const frame = new FrameUniforms()
  frame.size.value.setScalar(NOISE_SIZE)
  frame.marchedSize.value.setScalar(NOISE_SIZE)
  const inputs = Array.from({ length: NOISE_SIZE ** 2 }, () => [0])
  const found = await evaluateOnGpu(
    renderer,
    inputs,
    () => marchedPixel({ frame } as FrameInputs).noise
  )
  const at = (x: number, y: number): number => found[4 * (y * NOISE_SIZE + x)]
  const places = inputs.map((_, i) => [i % NOISE_SIZE, Math.floor(i / NOISE_SIZE)] as const)
  const values = places.map(([x, y]) => at(x, y))
  const deviation = (all: readonly number[]): number =>
    Math.sqrt(mean(all.map(value => (value - 0.5) ** 2)))
  const squares = places
    .filter(([x, y]) => x % 4 === 0 && y % 4 === 0)
    .map(([x, y]) => mean(inputs.slice(0, 16).map((_, i) => at(x + (i % 4), y + (i >> 2)))))
  // White noise: 12^{-1/2}, and a quarter of it.
  const [all, coarse] = [deviation(values), deviation(squares)]
  const likeness = (across: number, down: number): number =>
    mean(
      places
        .filter(([x, y]) => x >= 3 && x < NOISE_SIZE - 3 && y < NOISE_SIZE - 3)
        .map(([x, y]) => Math.cos(2 * Math.PI * (at(x, y) - at(x + across, y + down))))
    )
  const offsets = [0, 1, 2, 3].flatMap(down =>
    [-3, -2, -1, 0, 1, 2, 3].map(across => [across, down])
  )
  const most = Math.max(
    ...offsets.filter(([x, y]) => y > 0 || x > 0).map(([x, y]) => likeness(x, y))
  )
  t.note(
    `deviation ${all.toFixed(3)}, of squares ${coarse.toFixed(4)}, pixels alike ${most.toFixed(2)}`
  )
  expectTrue(Math.abs(all - 12 ** -0.5) < 0.01, `noise deviates by ${all}`)
  expectTrue(coarse < 0.5 * (12 ** -0.5 / 4), `squares of 16 pixels deviate by ${coarse}`)
  expectTrue(most < 0.1, `pixels some way apart are alike by ${most}`)
})
