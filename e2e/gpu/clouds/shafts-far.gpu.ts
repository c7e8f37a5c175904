import { CloudLayers } from '@welkin/clouds'
import { float, vec4 } from 'three/tsl'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { QualityUniforms } from '../../../packages/clouds/src/march/quality'
import { litClouds } from '../../../packages/clouds/src/march/tsl/shadePoints'
import type { Float, Vec3 } from '../../../packages/clouds/src/tsl-types'
import { castsOnce, measuredLoss, unseenClouds } from '../harness/cloud-shafts'
import { coarse, fog, SparseNoise } from '../harness/cloud-view'
import { evaluateOnGpu } from '../harness/evaluate'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest, takeFineShadows } from '../harness/gpu-test'
import { parameters, stage, stageSize as size } from '../harness/shaft-stage'

takeFineShadows()

const radians = Math.PI / 180

/** A block of cloud [1/m] by the range of each coordinate [m]. Above the equator, x is up, y east and z north. */
function block(
  { x, y, z }: Vec3,
  [west, east]: readonly [number, number],
  [south, north]: readonly [number, number],
  [low, high]: readonly [number, number]
): Float {
  const isLevel = x.greaterThan(low).and(x.lessThan(high))
  const isBeside = y.greaterThan(west).and(y.lessThan(east))
  const isInside = isLevel.and(isBeside).and(z.greaterThan(south)).and(z.lessThan(north))
  return isInside.select(0.05, 0)
}

gpuTest('has a tower of cloud shade the cloud behind it, and not one without a tower', async t => {
  const renderer = await t.createRenderer(size)
  const sun = 25
  const set = stage(renderer, sun, null)
  // Two clouds beside the camera, alike from it, and a tower north of the one in the east, where the sun is.
  const middle = 2000
  const { node, draw, dispose } = await unseenClouds(
    renderer,
    set,
    new CloudLayers([{ ...fog, baseAltitude: 400, topAltitude: 2400 }]),
    new SparseNoise(),
    ({ offset }) => {
      const [west, east] = [-middle, middle].map(y =>
        block(offset, [y - 300, y + 300], [-300, 300], [400, 800])
      )
      const tower = block(offset, [middle - 700, middle + 700], [1400, 2600], [400, 2400])
      return west.add(east).add(tower)
    }
  )
  for (let i = 0; i < 2; i++) await draw()
  const { field, light, shadows } = node
  const quality = new QualityUniforms()
  quality.set(coarse)
  const found = await evaluateOnGpu(
    renderer,
    [-1, 1].map(side => [side, 0, 0, 0]),
    ({ x: side }) => {
      const { up, lightDirection } = field.view
      const east = lightDirection.cross(up).normalize().mul(side)
      const place = up.mul(600).add(east.mul(middle)).toConst() as Vec3
      const ray = { direction: place.normalize().toConst() as Vec3, end: float(3500) }
      const context = { field, light: light.nodes, shadows: shadows.nodes, quality }
      const { radiance, transmittance } = litClouds(context, { ...ray, jitter: float(0.5) })
      return vec4(radiance.y, transmittance, 0, 0)
    }
  )
  const [lit, litThrough, shaded, shadedThrough] = [0, 1, 4, 5].map(i => found[i])
  t.note(`behind the tower ${(shaded / lit).toFixed(3)} of the light`)
  expectTrue(Math.max(litThrough, shadedThrough) < 0.05, 'both clouds are seen')
  // What is left is light of sky and ground.
  expectTrue(shaded > 0.05 * lit && shaded < 0.6 * lit, `${shaded} of ${lit}`)
  dispose()
  set.dispose()
})

gpuTest(
  "takes the light from the air in a storm's shadow, as seen from 400 km at dusk",
  async t => {
    const renderer = await t.createRenderer(size)
    const sun = 5
    const set = stage(renderer, sun, { quality: 'reference' })
    const { camera, shafts } = set
    camera.position.y = 400_000
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
    for (let i = 0; i < 2; i++) await draw()
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
