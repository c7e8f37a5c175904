import { CloudLayers } from '@welkin/clouds'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { castsOnce, measuredLoss, unseenClouds } from '../harness/cloud-shafts'
import { fog, SparseNoise } from '../harness/cloud-view'
import { expectClose } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { parameters, stage, stageSize as size } from '../harness/shaft-stage'

const radians = Math.PI / 180

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
