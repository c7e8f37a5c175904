import { airStyle, distanceFog, heightFog, lightTransmittance } from '@welkin/atmosphere'
import { float } from 'three/tsl'
import { densities, extinction } from '../../../packages/atmosphere/src/air/cpu/medium'
import { inScatter } from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import * as twin from '../../../packages/atmosphere/test/twins/fog/heightFog'
import { drawForward } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, parameters, stage, stageSize as size } from '../harness/shaft-stage'

gpuTest(
  'takes as much more from the air as an artistic factor gives it',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 12, { quality: 'medium' })
    const { scene, camera, shafts, atmosphere } = set
    const style = airStyle()
    atmosphere.add(style)
    shafts.add({ castInto: () => ({ transmittance: () => () => float(0) }) })
    const distance = 20_000
    addBox(scene, [0, 0, -distance - 50], [9000, 9000, 100]).material.color.set(0)
    camera.position.y = 500
    camera.fov = 1
    camera.updateProjectionMatrix()
    const forward = async (): Promise<Picture> => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    const air = parameters()
    const clear = extinction(air, densities(air, 500))
    for (const draw of [set.draw, forward]) {
      if (draw === forward) atmosphere.add(shafts)
      const lost: number[][] = []
      for (const haze of [0, 1, 2]) {
        style.set({ haze })
        shafts.enabled = false
        const lit = await draw()
        shafts.enabled = true
        const dark = await draw()
        const [x, y] = [size.width / 2, size.height / 2]
        lost.push(dark.at(x, y).map((light, k) => lit.at(x, y)[k] - light))
      }
      for (let k = 0; k < 3; k++) {
        const label = `${draw === forward ? 'materials' : 'post effect'}, channel ${k}`
        expectTrue(lost[0][k] === 0, `${label}: nothing to take`)
        // Where light is the same all along the ray.
        const ratio = 1 + Math.exp(-clear[k] * distance)
        t.note(`${(100 * (lost[2][k] / lost[1][k] / ratio - 1)).toFixed(2)} %`)
        expectClose(lost[2][k], ratio * lost[1][k], { relative: 0.01 }, label)
      }
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes what height fog scatters once from its light where all is dark',
  async t => {
    const renderer = await t.createRenderer(size)
    const elevation = 12
    const set = stage(renderer, elevation, { quality: 'reference' })
    const { scene, camera, draw, shafts, atmosphere } = set
    const [density, falloff, asymmetry, distance] = [0.004, 300, 0.75, 400]
    atmosphere.add(heightFog({ density, falloff, asymmetry }))
    shafts.add({ castInto: () => ({ transmittance: () => () => float(0) }) })
    addBox(scene, [0, 0, -distance - 50], [2000, 400, 100])
    camera.fov = 1
    camera.updateProjectionMatrix()
    const dark = await draw()
    shafts.enabled = false
    const lit = await draw()

    const air = parameters()
    const sun = (elevation * Math.PI) / 180
    const radius = air.bottomRadius + 2
    const ray = { radius, cosView: 0, cosLight: Math.sin(sun), cosViewLight: Math.cos(sun) }
    const layer = { density, falloff, base: 0 }
    const depth = twin.fogDepth(layer, radius, 0, air.bottomRadius, distance)
    const through = Math.exp(-depth)
    // The fog stands at half of its visible depth, and hides the air behind.
    const middle = (0.5 * Math.min(depth, 1)) / (density * Math.exp(-2 / falloff))
    const [before, all] = [middle, distance].map(far => inScatter(air, null, ray, far))
    const chord = 1 + asymmetry ** 2 - 2 * asymmetry * ray.cosViewLight
    const phase = (1 - asymmetry ** 2) / (4 * Math.PI * chord ** 1.5)
    const above = (density * falloff * (1 - asymmetry) * Math.exp(-2 / falloff)) / Math.sin(sun)
    const sunlight = lightTransmittance(air, radius, ray.cosLight)
    for (let k = 0; k < 3; k++) {
      const fog = phase * Math.exp(-above) * sunlight[k] * (1 - through)
      const expected = fog + before[k] + through * (all[k] - before[k])
      const [x, y] = [size.width / 2, size.height / 2]
      const irradiance = shafts.source.irradiance.value.getComponent(k)
      const lost = (lit.at(x, y)[k] - dark.at(x, y)[k]) / irradiance
      t.note(`${(100 * (lost / expected - 1)).toFixed(2)} %`)
      expectClose(lost, expected, { relative: 0.01 }, `channel ${k}`)
      expectTrue(dark.at(x, y)[k] > 0.1 * lit.at(x, y)[k], 'light scattered more often stays')
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes from moonlit air behind fog what the fog lets through',
  async t => {
    const renderer = await t.createRenderer(size)
    const [elevation, distance] = [25, 8000]
    const set = stage(renderer, elevation, { quality: 'medium' }, true)
    const { scene, camera, shafts, atmosphere } = set
    shafts.add({ castInto: () => ({ transmittance: () => () => float(0) }) })
    addBox(scene, [0, 0, -distance - 50], [9000, 4000, 100]).material.color.set(0)
    camera.fov = 1
    camera.updateProjectionMatrix()
    const forward = async (): Promise<Picture> => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    const fogs = [
      distanceFog({ density: 1 / distance }),
      heightFog({ density: 2e-4, falloff: 300 })
    ] as const
    // As in the test above, by how much the fog dims what is behind its middle.
    const air = parameters()
    const light = (elevation * Math.PI) / 180
    const radius = air.bottomRadius + 2
    const ray = { radius, cosView: 0, cosLight: Math.sin(light), cosViewLight: Math.cos(light) }
    const layer = { density: 2e-4, falloff: 300, base: 0 }
    const depth = twin.fogDepth(layer, radius, 0, air.bottomRadius, distance)
    const middle = (0.5 * Math.min(depth, 1)) / (layer.density * Math.exp(-2 / layer.falloff))
    const [before, all] = [middle, distance].map(far => inScatter(air, null, ray, far)[1])
    const left = [Math.exp(-1), (before + Math.exp(-depth) * (all - before)) / all]
    for (const draw of [set.draw, forward]) {
      // The volume that materials read is too coarse for a window of a degree.
      if (draw === forward) shafts.set({ quality: 'reference' })
      const lossIn = async (fog?: (typeof fogs)[number]): Promise<number> => {
        if (fog) atmosphere.add(fog)
        if (draw === forward) atmosphere.add(shafts)
        // The post effect takes other layers when it is told to.
        set.pipeline.needsUpdate = true
        await draw()
        const dark = (await draw()).at(size.width / 2, size.height / 2)[1]
        shafts.enabled = false
        await draw()
        const lit = (await draw()).at(size.width / 2, size.height / 2)[1]
        shafts.enabled = true
        if (draw === forward) atmosphere.remove(shafts)
        if (fog) atmosphere.remove(fog)
        expectTrue(dark > 0, 'light scattered more often stays')
        return lit - dark
      }
      const clear = await lossIn()
      expectTrue(clear > 0, 'moonlight is lost')
      // Materials take it from the same shader: one fog shows that they do.
      for (const [i, fog] of fogs.slice(0, draw === forward ? 1 : 2).entries()) {
        const part = (await lossIn(fog)) / clear
        t.note(`${fog.constructor.name}: ${part.toFixed(4)} of ${left[i].toFixed(4)}`)
        expectClose(part, left[i], { relative: 0.02 }, fog.constructor.name)
      }
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has materials draw shafts in fog as the post effect does',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15, { quality: 'reference' })
    const { scene, camera, shafts, atmosphere } = set
    atmosphere.add(distanceFog({ density: 1 / 4000 }), heightFog({ density: 0.001, falloff: 200 }))
    addBox(scene, [-100, 200, -600], [500, 500, 60])
    shafts.enabled = false
    const lit = await set.draw()
    shafts.enabled = true
    await set.draw()
    const post = await set.draw()
    atmosphere.add(shafts)
    const draw = async () => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    await draw()
    const forward = await draw()
    const [error, shadow] = [forward, lit].map(picture =>
      picture.data.reduce((sum, value, i) => sum + Math.abs(value - post.data[i]), 0)
    )
    t.note(`${(error / shadow).toFixed(4)} of the lost light apart`)
    expectTrue(error < 0.05 * shadow, 'forward')
    set.dispose()
  },
  { backends: ['webgpu'] }
)
