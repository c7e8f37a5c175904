import { CloudLayers, clouds } from '@welkin/clouds'
import { aerialPerspective } from '@welkin/atmosphere'
import { uv, vec4 } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { unpack } from '../../../packages/clouds/src/temporal/tsl/packing'
import type { Float, Vec2 } from '../../../packages/clouds/src/tsl-types'
import { drawToFloat } from '../harness/atmosphere'
import { coarse, fog, SparseNoise, viewSize } from '../harness/cloud-view'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import { stage } from '../harness/shaft-stage'

/** Distances of two clouds, of which the near one covers half of the far one [m]. */
const NEAR = 3000
const FAR = 24_000

/** Octaves beyond the near one, and before the far one, where there is none: rays meet them aslant. */
const BEYOND = 1.2
const BEFORE = 0.2

gpuTest(
  "pixels at the edge of a near cloud before a far one have one's distance or the other's",
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const set = stage(renderer, 40, null)
    const { camera, atmosphere, depth } = set
    camera.rotation.x = 0.4
    camera.aspect = viewSize.width / viewSize.height
    camera.updateProjectionMatrix()
    const noise = new SparseNoise()
    // Above the equator, x is up, y is east, and z is north.
    const walls = ({ x: up, y: east, z: north }: { x: Float; y: Float; z: Float }): Float => {
      const isNear = north.greaterThan(NEAR).and(north.lessThan(NEAR + 1000))
      const near = isNear.and(east.lessThan(north.mul(0.01))).and(up.greaterThan(0))
      return near.or(north.greaterThan(FAR)).select(0.05, 0)
    }
    const node = clouds(
      aerialPerspective(vec4(0), depth, camera, atmosphere),
      depth,
      camera,
      atmosphere,
      new CloudLayers([{ ...fog, baseAltitude: 0, topAltitude: 15_000 }]),
      {
        quality: { ...coarse, block: 4, steps: 128, stepGrowth: 0.01 },
        noise,
        extinction: ({ offset }) => walls(offset)
      }
    )
    set.pipeline.outputNode = node
    for (let frame = 0; frame < 40; frame++) await set.draw()
    const kept = new RenderPipeline(renderer)
    kept.outputColorTransform = false
    const { light, distances } = node.passes.accumulated
    const place = uv() as unknown as Vec2
    kept.outputNode = vec4(
      unpack(distances.sample(place).level(0)).x,
      light.sample(place).level(0).a,
      0,
      1
    )
    await nextFrame()
    const picture = await drawToFloat(renderer, () => kept.render())
    let count = 0
    let bad = 0
    for (let i = 0; i < picture.data.length; i += 4) {
      const [distance, transmittance] = picture.data.subarray(i)
      if (transmittance > 0.1) continue
      count++
      if (distance > Math.log2(NEAR) + BEYOND && distance < Math.log2(FAR) - BEFORE) bad++
    }
    t.note(`${count} pixels of clouds, ${bad} between them`)
    expectTrue(count > 100, `only ${count} pixels have clouds`)
    expectTrue(bad === 0, `${bad} pixels are at a distance where there is no cloud`)
    for (const owned of [kept, node, noise, set]) owned.dispose()
  },
  { backends: ['webgpu'] }
)
