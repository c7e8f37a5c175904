import type { AirOccluder } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import { uniform, vec4 } from 'three/tsl'
import { quantile } from '../../validate/score'
import { distanceToTop } from '../../../packages/atmosphere/src/air/cpu/boundary'
import {
  inScatter,
  type RayNumbers
} from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { addBox, expectSame, parameters, stage, stageSize as size } from '../harness/shaft-stage'

gpuTest('leaves a scene without casters the same to the last bit', async t => {
  const renderer = await t.createRenderer(size)
  const plain = stage(renderer, 20, null)
  const without = await plain.draw()
  const shafted = stage(renderer, 20)
  const withShafts = await shafted.draw()
  expectSame(withShafts, without, 'no casters')
  addBox(shafted.scene, [0, 200, -600], [50, 500, 50])
  const tower = await shafted.draw()
  expectTrue(
    tower.data.some((value, i) => value < 0.99 * without.data[i]),
    'a tower makes a difference'
  )
  plain.dispose()
  shafted.dispose()
})

gpuTest(
  'has no shafts by night, where neither sun nor moon shines',
  async t => {
    const renderer = await t.createRenderer(size)
    const pictures: Picture[] = []
    for (const options of [{}, null]) {
      // The moon is below the horizon, as the sun is.
      const set = stage(renderer, -20, options, true)
      addBox(set.scene, [0, 350, -300], [7000, 700, 2])
      pictures.push(await set.draw())
      if (options !== null) expectTrue(!set.shafts.isActive, 'shafts in no light')
      set.dispose()
    }
    expectSame(pictures[0], pictures[1], 'with and without shafts')
  },
  // Decided on the CPU.
  { backends: ['webgpu'] }
)

/** A ray of the stage's camera that looks at an angle above the horizon, in the north, where the sun is. */
function northward(elevation: number, sunElevation: number, altitude: number): RayNumbers {
  const [view, sun] = [elevation, sunElevation].map(angle => (angle * Math.PI) / 180)
  return {
    radius: parameters().bottomRadius + altitude,
    cosView: Math.sin(view),
    cosLight: Math.sin(sun),
    cosViewLight: Math.cos(view - sun)
  }
}

for (const isMoonlit of [false, true]) {
  const light = isMoonlit ? 'moonlight' : 'sunlight'
  gpuTest(
    `takes all ${light} scattered once from air behind a wall, and none before it`,
    async t => {
      const renderer = await t.createRenderer(size)
      const sunElevation = 12
      // The camera looks away from the sun, over a wall in its back, whose shadow ends in the air ahead.
      const options = { quality: 'reference' } as const
      const { scene, camera, draw, shafts, dispose } = stage(
        renderer,
        sunElevation,
        options,
        isMoonlit
      )
      const air = parameters()
      const [wall, height] = [300, 700]
      addBox(scene, [0, height / 2, -wall], [7000, height, 2])
      for (const viewElevation of [3, 25]) {
        const radians = (angle: number): number => (angle * Math.PI) / 180
        camera.fov = 1
        camera.updateProjectionMatrix()
        camera.lookAt(
          new Vector3(0, Math.sin(radians(viewElevation)), Math.cos(radians(viewElevation))).add(
            camera.position
          )
        )
        shafts.enabled = true
        const shadowed = await draw()
        shafts.enabled = false
        const lit = await draw()
        // The shadow's upper face falls from the wall's top; the ray rises from 2 m.
        const [fall, rise] = [sunElevation, viewElevation].map(angle => Math.tan(radians(angle)))
        const level = (height - 2 - wall * fall) / (rise + fall)
        const distance = level / Math.cos(radians(viewElevation))
        const ray = {
          ...northward(180 - viewElevation, sunElevation, 2),
          cosView: Math.sin(radians(viewElevation))
        }
        const expected = inScatter(air, null, ray, distance)
        const whole = inScatter(
          air,
          null,
          ray,
          distanceToTop(ray.radius, ray.cosView, air.topRadius)
        )
        const [x, y] = [size.width / 2, size.height / 2]
        const label = `view ${viewElevation}° up`
        for (let k = 0; k < 3; k++) {
          const irradiance = shafts.source.irradiance.value.getComponent(k)
          const lost = (lit.at(x, y)[k] - shadowed.at(x, y)[k]) / irradiance
          t.note(`${label}: ${((100 * (lost - expected[k])) / whole[k]).toFixed(3)} %`)
          expectClose(lost, expected[k], { absolute: 0.004 * whole[k] }, `${label}, channel ${k}`)
        }
      }
      dispose()
    },
    { backends: isMoonlit ? ['webgpu'] : ['webgpu', 'webgl'] }
  )
}

gpuTest(
  "has an occluder of one's own beyond all shadow maps",
  async t => {
    const renderer = await t.createRenderer(size)
    const { camera, draw, shafts, atmosphere, dispose } = stage(renderer, 25)
    const before = await draw()
    // All is dark east of the camera, of which the scene is ten times as large in these units.
    atmosphere.metersPerUnit = 0.1
    camera.position.set(5000, 20, 300)
    const lit = await draw()
    const occluder: AirOccluder = {
      castInto: () => ({
        transmittance:
          () =>
          ({ positionWorld }) =>
            positionWorld().x.greaterThan(5000).select(0, 1)
      })
    }
    shafts.add(occluder)
    const dark = await draw()
    for (const y of [4, 12]) {
      const row = Array.from({ length: size.width }, (_, x) => dark.at(x, y)[1] / lit.at(x, y)[1])
      const [west, east] = [row.slice(0, size.width / 2 - 4), row.slice(size.width / 2 + 4)]
      expectTrue(
        west.every(part => part === 1),
        `the west is lit: ${Math.min(...west)}`
      )
      expectTrue(
        east.every(part => part < 0.8),
        `the east is dark: ${Math.max(...east)}`
      )
    }
    shafts.remove(occluder)
    atmosphere.metersPerUnit = 1
    camera.position.set(0, 2, 0)
    expectSame(await draw(), before, 'taken out')
    dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes light scattered more than once where an occluder dims it',
  async t => {
    const renderer = await t.createRenderer(size)
    const { camera, draw, shafts, dispose } = stage(renderer, 25, { quality: 'reference' })
    // Pixels so small that the light of four is that of each.
    camera.fov = 10
    camera.updateProjectionMatrix()
    camera.lookAt(-1000, 300, 0)
    const light = { direct: 1, diffuse: 1 }
    const [direct, diffuse] = [uniform(1), uniform(1)]
    shafts.add({
      castInto: () => ({
        transmittance: () => () => direct,
        diffuse: () => vec4(diffuse)
      })
    })
    const drawWith = async (changes: Partial<typeof light>): Promise<Picture> => {
      direct.value = changes.direct ?? 1
      diffuse.value = changes.diffuse ?? 1
      return draw()
    }
    const all = await drawWith({})
    shafts.enabled = false
    expectSame(await draw(), all, 'light that is all there')
    shafts.enabled = true
    const [once, often, none, more] = [
      await drawWith({ diffuse: 0 }),
      await drawWith({ direct: 0 }),
      await drawWith({ direct: 0, diffuse: 0 }),
      await drawWith({ diffuse: 1.5 })
    ]
    const errors: number[] = []
    for (let y = 0; y < size.height; y += 5) {
      for (let x = 1; x < size.width; x += 7) {
        for (let k = 0; k < 3; k++) {
          const [whole, a, b, left, bright] = [all, once, often, none, more].map(
            picture => picture.at(x, y)[k]
          )
          errors.push(left / whole, (a + b) / whole - 1, (bright - whole) / (whole - a) - 0.5)
        }
      }
    }
    const worst = quantile(errors.map(Math.abs), 0.98)
    t.note(`98 % within ${worst.toFixed(5)}`)
    // That of the sky volume's own texels included.
    expectTrue(worst < 0.025, `light is off by ${worst}`)
    dispose()
  },
  { backends: ['webgpu'] }
)
