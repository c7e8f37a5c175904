import { CloudLayers, CloudLightTable, clouds } from '@welkin/clouds'
import { Vector3 } from 'three'
import { uniform } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import type { Float, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { drawToFloat } from '../harness/atmosphere'
import { castsOnce, measuredLoss, unseenClouds } from '../harness/cloud-shafts'
import { coarse, fog, SparseNoise } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { parameters, stage, stageSize as size } from '../harness/shaft-stage'

const radians = Math.PI / 180

/**
 * A block of cloud by the range of each coordinate [m]. Above the equator, x is up, y east and z north.
 *
 * @param east - Its middle, and half its width.
 */
const block = (
  { x, y, z }: Vec3,
  [middle, half]: readonly [number, number | Float],
  [south, north]: readonly [number, number],
  [low, high]: readonly [number, number]
): Float => {
  const isLevel = x.greaterThan(low).and(x.lessThan(high))
  const isInside = isLevel.and(z.greaterThan(south)).and(z.lessThan(north))
  return isInside.and(y.sub(middle).abs().lessThan(half)).select(0.05, 0)
}

gpuTest('has a tower of cloud shade the cloud behind it, and no other', async t => {
  const renderer = await t.createRenderer(size)
  const set = stage(renderer, 25, null)
  const { camera, air, depth, atmosphere } = set
  const [light, noise] = [new CloudLightTable(), new SparseNoise()]
  /** Half of the tower's width [m]; wide, it shades all. */
  const width = uniform(0) as unknown as Float & { value: number }
  const layers = new CloudLayers([{ ...fog, baseAltitude: 400, topAltitude: 1400 }])
  // Sunlight from the north passes the tower at the height of 960 m on its way to the cloud.
  const [behind, aside] = [0, 2000]
  const node = clouds(air, depth, camera, atmosphere, layers, {
    quality: coarse,
    noise,
    light,
    extinction: ({ offset }) =>
      block(offset, [behind, 360], [-2760, -2040], [400, 640])
        .add(block(offset, [aside, 360], [-2760, -2040], [400, 640]))
        .add(block(offset, [0, width], [-1800, -600], [760, 1400]))
  })
  node.time = 0
  const pipeline = new RenderPipeline(renderer)
  pipeline.outputColorTransform = false
  pipeline.outputNode = node
  camera.lookAt(new Vector3(0.3, 0.2, 1).add(camera.position))
  camera.updateMatrixWorld()
  const brightness: number[][] = []
  for (const [i, half] of [0, 600, 4000].entries()) {
    width.value = half
    // What is drawn is no layer's, so that shadows must be told.
    node.field.layers.at(0).set({ density: 0.004 + i * 1e-6 })
    // Cascades are drawn in strips, and history forgets.
    for (let frame = 0; frame < 13; frame++) {
      await nextFrame()
      pipeline.render()
    }
    await nextFrame()
    const picture = await drawToFloat(renderer, () => pipeline.render())
    brightness.push(
      [behind, aside].map(east => {
        const place = new Vector3(east, 500, 2040).project(camera)
        const [x, y] = [(place.x + 1) / 2, (1 - place.y) / 2]
        return picture.at(Math.floor(x * size.width), Math.floor(y * size.height))[1]
      })
    )
  }
  const [lit, tower, all] = brightness
  const parts = [0, 1].map(i => (lit[i] - tower[i]) / (lit[i] - all[i]))
  t.note(`sunlight is ${(1 - all[0] / lit[0]).toFixed(3)} of its light`)
  t.note(`of it the tower takes ${parts.map(part => part.toFixed(3)).join(' and ')}`)
  expectTrue(all[0] < 0.8 * lit[0], 'sunlight shows')
  expectClose(parts[0], 1, { absolute: 0.05 }, 'the cloud behind the tower')
  expectClose(parts[1], 0, { absolute: 0.05 }, 'the other cloud')
  for (const owned of [node, pipeline, light, noise, set]) owned.dispose()
})

gpuTest(
  "takes the light from the air in a storm's shadow, as seen from 120 km at dusk",
  async t => {
    const renderer = await t.createRenderer(size)
    const sun = 5
    const set = stage(renderer, sun, { quality: 'reference' })
    const { camera, shafts } = set
    camera.position.y = 120_000
    camera.fov = 0.2
    camera.near = 1000
    camera.updateProjectionMatrix()
    camera.up.set(0, 0, -1)
    camera.lookAt(0, 0, 0)
    const [base, top, half, north] = [1000, 12_000, 20_000, 60_000]
    const { node, draw, dispose } = await unseenClouds(
      renderer,
      set,
      new CloudLayers([{ ...fog, baseAltitude: base, topAltitude: top }]),
      new SparseNoise(),
      ({ offset: { y, z } }) => {
        const outside = y.abs().max(z.sub(north).abs()).greaterThan(half)
        return outside.select(0, 0.02)
      }
    )
    shafts.add(castsOnce(node))
    for (let i = 0; i < 14; i++) await draw()
    const air = parameters()
    const [up, along] = [Math.sin(sun * radians), Math.cos(sun * radians)]
    const ray = { radius: air.topRadius, cosView: -1, cosLight: up, cosViewLight: -up }
    // Air is dark from where sunlight just passes over the storm's near edge.
    const near = north - half
    const edge = top - (near * up) / along - near ** 2 / (2 * air.bottomRadius)
    const thickness = air.topRadius - air.bottomRadius
    const whole = inScatter(air, null, ray, thickness)
    const above = inScatter(air, null, ray, thickness - edge)
    const got = await measuredLoss(set)
    for (let k = 0; k < 3; k++) {
      const lost = whole[k] - above[k]
      t.note(`lost ${(lost / whole[k]).toFixed(3)}, got ${(got[k] / whole[k]).toFixed(3)}`)
      expectClose(got[k], lost, { absolute: 0.05 * whole[k] }, `#${k}`)
    }
    dispose()
    set.dispose()
  }
)
