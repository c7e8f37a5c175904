import {
  aerialPerspective,
  aerialPerspectiveFog,
  AtmosphereShell,
  forwardShafts,
  moon,
  MoonDirectionalLight,
  skyBackground,
  type AirOccluder,
  type ForwardShafts
} from '@welkin/atmosphere'
import { FloatType, Scene } from 'three'
import { float, pass } from 'three/tsl'
import { RenderPipeline } from 'three/webgpu'
import { drawForward, drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, expectSame, stage, stageSize as size } from '../harness/shaft-stage'

/** Part of the numbers of two pictures that differ. */
const differing = (a: Picture, b: Picture): number =>
  a.data.filter((value, i) => value !== b.data[i]).length / a.data.length

gpuTest(
  'draws the shafts of sun and moon in one post effect, each by its light',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { scene, camera, atmosphere, light } = set
    addBox(scene, [0, 200, -600], [200, 500, 40])
    const luna = moon({ direction: atmosphere.sunDirection, mapSize: 64 })
    atmosphere.add(luna)
    const moonlight = new MoonDirectionalLight(atmosphere, luna, 6000)
    moonlight.castShadow = true
    moonlight.shadow.copy(light.shadow)
    scene.add(moonlight, moonlight.target)
    const shafts = [light, moonlight].map(each => forwardShafts(atmosphere, camera, each))
    const [ofSun, ofMoon] = shafts
    const scenePass = pass(scene, camera, { samples: 0, type: FloatType })
    const [color, depth] = [scenePass.getTextureNode(), scenePass.getTextureNode('depth')]
    const drawers = [shafts, [ofSun], [ofMoon]].map(given => {
      const pipeline = new RenderPipeline(renderer)
      pipeline.outputColorTransform = false
      pipeline.outputNode = aerialPerspective(color, depth, camera, atmosphere, { shafts: given })
      return pipeline
    })
    for (const [source, elevation] of [
      ['sun', 15],
      ['moon', -50]
    ] as const) {
      const before = atmosphere.sunDirection.clone()
      atmosphere.setSunAngles(elevation, source === 'sun' ? 0 : 180)
      if (source === 'moon') luna.direction = before
      camera.updateMatrixWorld()
      const pictures: Picture[] = []
      for (const pipeline of drawers) {
        for (let i = 0; i < 2; i++) {
          await nextFrame()
          pictures[drawers.indexOf(pipeline)] = await drawToFloat(renderer, () => pipeline.render())
        }
      }
      const [both, sunOnly, moonOnly] = pictures
      const [own, other] = source === 'sun' ? [sunOnly, moonOnly] : [moonOnly, sunOnly]
      t.note(`by the ${source} ${(100 * differing(own, other)).toFixed(0)} % has shafts`)
      expectTrue(differing(own, other) > 0.05, `a tower before the ${source} casts a shaft`)
      expectSame(both, own, `shafts of the ${source}`)
    }
    for (const owned of [...drawers, scenePass, ...shafts, moonlight, set]) owned.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  "takes as much light as the intensity of the light's shadow says",
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { scene, camera, light, shafts, atmosphere } = set
    addBox(scene, [0, 200, -600], [400, 500, 40]).receiveShadow = false
    const forward = async (): Promise<Picture> => {
      await nextFrame()
      return drawForward(renderer, scene, camera, atmosphere)
    }
    for (const draw of [set.draw, forward]) {
      if (draw === forward) atmosphere.add(shafts)
      const drawAt = async (intensity: number): Promise<Picture> => {
        light.shadow.intensity = intensity
        await draw()
        return draw()
      }
      const [full, half, none] = [await drawAt(1), await drawAt(0.5), await drawAt(0)]
      shafts.enabled = false
      expectSame(none, await drawAt(0), 'shadows without intensity')
      shafts.enabled = true
      const lost = [full, half].map(picture =>
        picture.data.reduce((sum, value, i) => sum + none.data[i] - value, 0)
      )
      const all = none.data.reduce((sum, value) => sum + value, 0)
      t.note(
        `${((100 * lost[0]) / all).toFixed(2)} % is lost, half of it ${(lost[1] / lost[0]).toFixed(4)}`
      )
      expectTrue(lost[0] > 1e-3 * all, 'the tower casts a shadow')
      expectClose(lost[1] / lost[0], 0.5, { absolute: 0.005 }, 'half the intensity')
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

/** Occluder that takes no light, but is asked for it. */
const clear: AirOccluder = { castInto: () => ({ transmittance: () => () => float(1) }) }

gpuTest(
  'leaves materials and a shell that nothing shades the same to the last bit',
  async t => {
    const renderer = await t.createRenderer(size)
    const pictures: Picture[][] = []
    for (const hasShafts of [false, true]) {
      const set = stage(renderer, 20)
      const { scene, camera, shafts, atmosphere } = set
      // Takes shadows and casts none, so that there is a map of nothing.
      const ground = addBox(scene, [0, -5, 0], [4000, 10, 4000])
      ground.castShadow = false
      const drawn: Picture[] = []
      for (const occluders of [[], [clear]]) {
        if (hasShafts) atmosphere.add(shafts.add(...occluders))
        camera.updateMatrixWorld()
        for (let i = 0; i < 2; i++) await nextFrame()
        await drawForward(renderer, scene, camera, atmosphere)
        await nextFrame()
        drawn.push(await drawForward(renderer, scene, camera, atmosphere))
        expectTrue(!hasShafts || shafts.isActive, 'shafts are drawn')
        if (hasShafts) atmosphere.remove(shafts)
      }
      const { parameters, ellipsoid } = atmosphere
      const given = hasShafts ? { shafts } : { sun: atmosphere }
      const shell = new AtmosphereShell(parameters, ellipsoid.radii.x, given)
      atmosphere.worldToECEF
        .clone()
        .invert()
        .decompose(shell.position, shell.quaternion, shell.scale)
      const air = new Scene().add(shell)
      await nextFrame()
      await drawToFloat(renderer, () => renderer.render(air, camera))
      await nextFrame()
      drawn.push(await drawToFloat(renderer, () => renderer.render(air, camera)))
      expectTrue(!hasShafts || shafts.isActive, 'shafts are drawn in the shell')
      pictures.push(drawn)
      for (const owned of [shell, set]) owned.dispose()
    }
    const [without, withShafts] = pictures
    for (const [i, label] of ['a map of nothing', 'an occluder of nothing', 'a shell'].entries()) {
      expectTrue(
        without[i].data.some(value => value > 0),
        `${label}: there is light`
      )
      expectSame(withShafts[i], without[i], label)
    }
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has materials draw two cameras in a frame as they draw each alone',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { scene, atmosphere, light } = set
    addBox(scene, [0, 200, -600], [200, 500, 40])
    const other = set.camera.clone()
    other.position.set(-200, 60, 100)
    other.lookAt(0, 300, -600)
    const cameras = [set.camera, other]
    const shafts: ForwardShafts[] = [set.shafts, forwardShafts(atmosphere, other, light)]
    atmosphere.add(...shafts)
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    for (const camera of cameras) {
      camera.updateMatrixWorld()
      await renderer.compileAsync(scene, camera)
    }
    const draw = (camera: typeof other): Promise<Picture> =>
      drawToFloat(renderer, () => renderer.render(scene, camera))
    const alone: Picture[] = []
    for (const [i, camera] of cameras.entries()) {
      for (let frame = 0; frame < 2; frame++) {
        await nextFrame()
        alone[i] = await draw(camera)
      }
      shafts[i].enabled = false
      await nextFrame()
      expectTrue(differing(await draw(camera), alone[i]) > 0.05, `camera ${i} has shafts`)
      shafts[i].enabled = true
    }
    for (let frame = 0; frame < 2; frame++) {
      await nextFrame()
      for (const [i, camera] of cameras.entries()) {
        expectSame(await draw(camera), alone[i], `camera ${i} in frame ${frame}`)
      }
    }
    for (const owned of [shafts[1], set]) owned.dispose()
  },
  { backends: ['webgpu'] }
)

/** Most memory of shafts in a picture of 1920×1080 [B]. */
const MEMORY = 10e6

gpuTest(
  'takes up to 10 MB for each light in a picture of 1920×1080, at the highest quality',
  async t => {
    const renderer = await t.createRenderer({ width: 1920, height: 1080 })
    const quality = 'high'
    const sizeOf = async (path: string): Promise<number> => {
      const set = stage(renderer, 15, path === 'post effect' ? { quality } : null)
      const { scene, camera, atmosphere, shafts } = set
      const tower = addBox(scene, [0, 200, -600], [200, 500, 40])
      tower.receiveShadow = false
      if (path === 'materials') {
        shafts.set({ quality })
        atmosphere.add(shafts)
        camera.updateMatrixWorld()
        await nextFrame()
        await drawForward(renderer, scene, camera, atmosphere)
      }
      await set.draw()
      expectTrue(path === 'none' || shafts.isActive, 'shafts are drawn')
      const size = renderer.info.memory.texturesSize
      set.dispose()
      return size
    }
    const none = await sizeOf('none')
    for (const path of ['post effect', 'materials']) {
      const bytes = (await sizeOf(path)) - none
      t.note(`${path}: ${(bytes / 1e6).toFixed(2)} MB`)
      expectTrue(bytes > 5e5 && bytes <= MEMORY, `${path} takes ${bytes} B`)
    }
  },
  // The same targets on both.
  { backends: ['webgpu'] }
)
