import {
  aerialPerspectiveFog,
  skyBackground,
  type AirOccluder,
  type LightShaftsOptions
} from '@welkin/atmosphere'
import { PCFShadowMap, Vector3, VSMShadowMap } from 'three'
import { uniform, vec4 } from 'three/tsl'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { quantile } from '../../validate/score'
import { distanceToTop } from '../../../packages/atmosphere/src/air/cpu/boundary'
import {
  inScatter,
  type RayNumbers
} from '../../../packages/atmosphere/src/scattering/cpu/scattering'
import { drawForward, drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countCompilations, countObjects, nextFrame } from '../harness/graphics'
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
    }
  )
}

gpuTest(
  'draws the same with standard and reversed depth, and follows its caster in the same frame',
  async t => {
    const pictures: Picture[] = []
    for (const reversedDepthBuffer of [false, true]) {
      const renderer = await t.createRenderer({ ...size, reversedDepthBuffer })
      const { scene, draw, dispose } = stage(renderer, 15)
      const tower = addBox(scene, [-300, 200, -600], [40, 500, 40])
      const before = await draw()
      tower.position.x = 100
      const after = await draw()
      const fresh = stage(renderer, 15)
      addBox(fresh.scene, [100, 200, -600], [40, 500, 40])
      expectSame(after, await fresh.draw(), 'moved caster')
      expectTrue(
        before.data.some((value, i) => Math.abs(value - after.data[i]) > 0.01 * value),
        'the shadow moves'
      )
      pictures.push(after)
      dispose()
      fresh.dispose()
    }
    const [standard, reversed] = pictures
    const differences = standard.data
      .map((value, i) => Math.abs(value - reversed.data[i]) / (value + 1e-6))
      .toSorted()
    expectTrue(differences[Math.floor(0.99 * differences.length)] < 2e-3, 'reversed depth')
  }
)

gpuTest("reads three's cascades as it reads one map", async t => {
  const renderer = await t.createRenderer(size)
  const pictures: Picture[] = []
  for (const kind of ['map', 'cascades', 'lit']) {
    const { scene, light, draw, shafts, dispose } = stage(renderer, 15)
    const tower = addBox(scene, [-100, 200, -600], [150, 500, 60])
    // Not seen itself: its own front is where shadow maps of other texels differ.
    Object.assign(tower.material, { colorWrite: false, depthWrite: false })
    if (kind === 'cascades') {
      const shadowNode = new CSMShadowNode(light, { cascades: 3, maxFar: 3000, lightMargin: 2000 })
      Object.assign(light.shadow, { shadowNode })
    }
    if (kind === 'lit') shafts.enabled = false
    // CSM draws the cascades of a frame where it has put them in the frame before.
    await draw()
    pictures.push(await draw())
    dispose()
  }
  const [map, cascades, lit] = pictures
  const apart = (a: Picture, b: Picture): number[] =>
    [...a.data].map((value, i) => Math.abs(value - b.data[i]) / (lit.data[i] + 1e-6))
  const [errors, shadows] = [apart(cascades, map), apart(map, lit)].map(all => quantile(all, 0.98))
  t.note(
    `98 % of pixels differ by less than ${errors.toFixed(4)}, by shadows ${shadows.toFixed(4)}`
  )
  expectTrue(shadows > 0.02, 'the tower casts a shadow')
  expectTrue(errors < 0.1 * shadows, 'cascades')
})

gpuTest(
  'has materials draw the air as the post effect does, in the frame in which casters move',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, camera, draw, shafts, atmosphere, dispose } = stage(renderer, 15, {
      quality: 'reference'
    })
    const tower = addBox(scene, [-300, 200, -600], [500, 500, 60])
    tower.material.color.set(0)
    await draw()
    tower.position.x = -100
    const post = await draw()
    shafts.enabled = false
    const lit = await draw()
    shafts.enabled = true
    atmosphere.add(shafts)
    const forward = async (): Promise<Picture> => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    const apart = (a: Picture, b: Picture): number =>
      a.data.reduce((sum, value, i) => sum + Math.abs(value - b.data[i]), 0)
    const shadows = apart(post, lit)
    const all = lit.data.reduce((sum, value) => sum + value, 0)
    expectTrue(shadows > 2e-4 * all, 'the tower casts a shadow')
    // By marching, and by the volume.
    for (const quality of ['reference', 'medium'] as const) {
      shafts.set({ quality })
      tower.position.x = -300
      await forward()
      // The background is drawn first, and with shadows of this frame.
      tower.position.x = -100
      const moved = await forward()
      expectSame(await forward(), moved, 'a frame later')
      const part = apart(moved, post) / shadows
      t.note(`${quality}: ${part.toFixed(3)} of the lost light apart`)
      expectTrue(part < 0.15, `forward, ${quality}`)
    }
    dispose()
  }
)

gpuTest('draws cascades before the sky, in the frame in which casters move', async t => {
  const renderer = await t.createRenderer(size)
  const { scene, camera, light, shafts, atmosphere, dispose } = stage(renderer, 15)
  const tower = addBox(scene, [-300, 200, -600], [500, 500, 60])
  const shadowNode = new CSMShadowNode(light, { cascades: 3, maxFar: 3000, lightMargin: 2000 })
  Object.assign(light.shadow, { shadowNode })
  atmosphere.add(shafts)
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  camera.updateMatrixWorld()
  const draw = async (x: number): Promise<Picture> => {
    tower.position.x = x
    await nextFrame()
    return drawToFloat(renderer, () => renderer.render(scene, camera))
  }
  for (let i = 0; i < 3; i++) await draw(-300)
  const before = await draw(-300)
  const moved = await draw(100)
  const differs = moved.data.filter((value, i) => value !== before.data[i]).length
  expectTrue(differs > 0.1 * moved.data.length, 'the tower has moved')
  expectSame(await draw(100), moved, 'a frame later')
  dispose()
})

gpuTest(
  'changes strength, quality and being on without a compile, and frees what it made',
  async t => {
    const renderer = await t.createRenderer(size)
    const { scene, draw, shafts, dispose } = stage(renderer, 15, { quality: 'high' })
    addBox(scene, [0, 200, -600], [200, 500, 40])
    const full = await draw()
    const compilations = countCompilations(renderer)
    shafts.set({ strength: 0.5, quality: 'low' })
    await draw()
    shafts.set({ strength: 1, quality: 'high' })
    expectSame(await draw(), full, 'back again')
    shafts.enabled = false
    const lit = await draw()
    shafts.set({ enabled: true, strength: 0.5 })
    const half = await draw()
    const [x, y] = [size.width / 2, 8]
    const [a, b, c] = [full, half, lit].map(picture => picture.at(x, y)[1])
    expectTrue(a < 0.99 * c, 'the tower casts a shadow')
    expectClose(b, (a + c) / 2, { relative: 1e-4 }, 'half the strength')
    expectTrue(
      Object.values(compilations).every(count => count === 0),
      'nothing is compiled'
    )
    dispose()
  }
)

// WebGPU loads depths, whatever they are; WebGL compares with those that are made for that.
gpuTest(
  "reads the shadow maps of now: three makes others when a light casts anew, and VSM's",
  async t => {
    for (const type of [PCFShadowMap, VSMShadowMap]) {
      const renderer = await t.createRenderer(size)
      renderer.shadowMap.type = type
      const { scene, light, draw, dispose } = stage(renderer, 15)
      const tower = addBox(scene, [0, 200, -600], [200, 500, 40])
      const found: number[][] = []
      for (const [i, x] of [-200, 200].entries()) {
        light.castShadow = false
        tower.position.x = x
        const lit = await draw()
        light.castShadow = true
        await draw()
        const dark = await draw()
        found[i] = [0, size.width / 2].map(from => {
          let lost = 0
          for (let x = from; x < from + size.width / 2; x++) {
            for (let y = 2; y < 12; y++) lost += 1 - dark.at(x, y)[1] / lit.at(x, y)[1]
          }
          return lost
        })
      }
      t.note(
        found
          .flat()
          .map(lost => lost.toFixed(2))
          .join(', ')
      )
      expectTrue(found[0][0] > 1 && found[0][0] > 3 * found[0][1], 'a tower on the left, and dark')
      expectTrue(found[1][1] > 1 && found[1][1] > 3 * found[1][0], 'and on the right')
      dispose()
    }
  },
  { backends: ['webgl'] }
)

gpuTest("has an occluder of one's own beyond all shadow maps", async t => {
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
})

gpuTest('takes light scattered more than once where an occluder dims it', async t => {
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
})

gpuTest('frees its textures', async t => {
  const renderer = await t.createRenderer(size)
  const { scene, camera, atmosphere, draw, shafts, dispose } = stage(renderer, 15)
  addBox(scene, [0, 200, -600], [200, 500, 40])
  shafts.enabled = false
  await draw()
  const objects = countObjects(renderer)
  shafts.enabled = true
  const first = await draw()
  expectTrue((objects.Texture ?? 0) > 0, 'shafts have textures')
  const held = objects.Texture
  shafts.dispose()
  expectTrue(objects.Texture < held, `${held} textures, ${objects.Texture} after dispose`)
  expectSame(await draw(), first, 'used again')

  // The volume of materials is there while they read it.
  const sizeOf = (): number => renderer.info.memory.texturesSize
  shafts.quality = 'medium'
  await draw()
  const least = sizeOf()
  atmosphere.add(shafts)
  const sizeWith = async (options: LightShaftsOptions): Promise<number> => {
    shafts.set(options)
    await nextFrame()
    await drawForward(renderer, scene, camera, atmosphere)
    return sizeOf()
  }
  const most = await sizeWith({})
  const off = await sizeWith({ enabled: false })
  const again = await sizeWith({ enabled: true })
  atmosphere.remove(shafts)
  await draw()
  const after = sizeOf()
  t.note(`${least} B of textures, ${most} with a volume, ${off} while it is off, ${after} after it`)
  expectTrue(most > least + 1e6, 'the volume takes memory')
  expectTrue(off === most && again === most, 'as much while they are off')
  expectTrue(after <= least, 'all of it is freed')
  dispose()
})

gpuTest('is turned on and off in materials that stand still, and changes quality', async t => {
  const renderer = await t.createRenderer(size)
  const { scene, camera, atmosphere, shafts, dispose } = stage(renderer, 15)
  addBox(scene, [0, 200, -600], [200, 500, 40])
  atmosphere.add(shafts)
  scene.backgroundNode = skyBackground(atmosphere)
  scene.fogNode = aerialPerspectiveFog(atmosphere)
  camera.updateMatrixWorld()
  // Compiled, the first frame has them too.
  await renderer.compileAsync(scene, camera)
  const draw = async (options: LightShaftsOptions): Promise<Picture> => {
    shafts.set(options)
    await nextFrame()
    return drawToFloat(renderer, () => renderer.render(scene, camera))
  }
  const first = await draw({ quality: 'medium' })
  expectSame(await draw({}), first, 'a frame later')
  const lit = await draw({ enabled: false })
  const differs = first.data.filter((value, i) => value !== lit.data[i]).length
  expectTrue(differs > 0.1 * lit.data.length, 'the box casts a shadow')
  expectSame(await draw({ enabled: true }), first, 'on again')
  const qualities = ['low', 'high', 'reference', 'medium'] as const
  for (const quality of qualities) {
    await draw({ quality })
    expectSame(await draw({ enabled: false }), lit, `${quality} quality, off`)
    shafts.enabled = true
  }
  expectSame(await draw({}), first, 'medium again')
  dispose()
})
