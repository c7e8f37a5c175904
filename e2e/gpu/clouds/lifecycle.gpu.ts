import {
  iceCrystals,
  raindrops,
  SkyLightProbe,
  SunDirectionalLight,
  SurfaceWater,
  wetSurface
} from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  cloudShadow,
  cloudSkyLight,
  DropletLightTable,
  lightning,
  PrecipitationGauge,
  precipitationShafts
} from '@welkin/clouds'
import { BoxGeometry, Mesh, MeshLambertMaterial, Vector3 } from 'three'
import { shadow } from 'three/tsl'
import { MeshStandardNodeMaterial } from 'three/webgpu'
import { ROUND } from '../../../packages/clouds/src/march/FrameUniforms'
import { drawToFloat } from '../harness/atmosphere'
import {
  CloudView,
  SparseNoise,
  fog,
  inFog,
  onGround,
  viewInFog,
  viewSize
} from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countObjects, finishWork, nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

/** Frames in which a picture of blocks of four pixels becomes whole twice. */
const FRAMES = 8

const meanOf = ({ data }: Picture): number => {
  let sum = 0
  for (let i = 0; i < data.length; i += 4) sum += data[i] + data[i + 1] + data[i + 2]
  return sum / (0.75 * data.length)
}

/** Mean difference between pictures, by the brightness of the first. */
const difference = (a: Picture, b: Picture): number =>
  a.data.reduce((sum, value, i) => sum + (i % 4 < 3 ? Math.abs(value - b.data[i]) : 0), 0) /
  (meanOf(a) * 0.75 * a.data.length)

gpuTest(
  'a scene is lit again when its clouds are disposed of, and shaded by the next ones',
  t =>
    inFog(t, async (first, shared) => {
      const { renderer, scene, camera, atmosphere } = first
      renderer.shadowMap.enabled = true
      const sun = new SunDirectionalLight(atmosphere)
      const sky = new SkyLightProbe(atmosphere)
      const board = new Mesh(new BoxGeometry(400, 1, 400), new MeshLambertMaterial())
      board.position.set(0, 1480, -200)
      board.receiveShadow = true
      scene.add(board, sun, sky)
      const draw = async (): Promise<number> => {
        await nextFrame()
        const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
        return Math.max(picture.at(12, 2)[1], picture.at(12, 11)[1])
      }
      const open = await draw()
      const shade = async (view: CloudView): Promise<number> => {
        Object.assign(sun.shadow, { shadowNode: cloudShadow(view.node, shadow(sun)) })
        cloudSkyLight(sky, view.node)
        sun.castShadow = true
        sun.dispose()
        await view.draw(2)
        return draw()
      }
      const shaded = await shade(first)
      // What a node makes for itself goes with it.
      first.dispose()
      shared.noise.dispose()
      const light = [await draw(), await draw()]
      const second = viewInFog(renderer, atmosphere, shared)
      const again = await shade(second)
      t.note([open, shaded, ...light, again].map(value => value.toFixed(4)).join(', '))
      expectTrue(shaded < 0.9 * open, `in shadow the ground has ${shaded}, else ${open}`)
      for (const value of light) expectClose([value], [open], { relative: 1e-3 }, 'without clouds')
      expectClose([again], [shaded], { relative: 0.02 }, 'with others')
      second.dispose()
    }),
  // What the backend has no part in.
  { backends: ['webgpu'] }
)

gpuTest(
  'a layer that becomes one of storms at once looks as one that always was, and back',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const atmosphere = onGround()
    const shared = { noise: new SparseNoise(), light: new CloudLightTable() }
    const layerOf = (weatherWeights: [number, number, number, number]) => {
      const deck = { ...fog, topAltitude: 9000, coverage: 0.9, density: 0.01, anvil: 1 }
      return { ...deck, weatherWeights }
    }
    const [deck, storms] = [layerOf([1, 0, 0, 0]), layerOf([0, 0, 1, 0])]
    const view = (layer: typeof deck): { view: CloudView; layers: CloudLayers } => {
      const layers = new CloudLayers([layer])
      const made = new CloudView(renderer, atmosphere, layers, shared)
      made.camera.position.set(0, 12_000, 0)
      made.camera.rotation.x = -0.4
      return { view: made, layers }
    }
    /** Draws frames without those before: all tiles of rays have been marched whole, which takes turns. */
    const drawAnew = async (view: CloudView, frames: number): Promise<Picture> => {
      view.node.accumulates = false
      const picture = await view.draw(frames)
      view.node.accumulates = true
      return picture
    }
    const changed = view(deck)
    const before = await drawAnew(changed.view, 3 * ROUND)
    await changed.view.draw(FRAMES)
    changed.layers.at(0).set(storms)
    const after = await changed.view.draw(FRAMES)
    changed.layers.at(0).set(deck)
    const back = await drawAnew(changed.view, 3 * ROUND)
    const always = view(storms)
    // As many frames, which march the same pixels of each block; a jump of the camera leaves no history.
    await drawAnew(always.view, 3 * ROUND + FRAMES - 1)
    always.view.camera.position.y += 1e5
    await always.view.draw()
    always.view.camera.position.y -= 1e5
    const expected = await always.view.draw(FRAMES)
    const [same, other, again] = [
      difference(expected, after),
      difference(expected, before),
      difference(before, back)
    ]
    t.note(`${same.toFixed(4)} apart, before ${other.toFixed(3)}, and back ${again.toFixed(4)}`)
    expectTrue(other > 0.05, `storms differ from a deck by ${other} only`)
    expectTrue(same < 0.005, `they are ${same} apart`)
    expectTrue(again < 0.005, `back they are ${again} apart`)
    for (const each of [changed.view, always.view, shared.noise, shared.light, atmosphere]) {
      each.dispose()
    }
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'two cameras with a node each in a frame see what each sees alone; so after a resize',
  t =>
    inFog(t, async (first, shared) => {
      const { renderer, atmosphere } = first
      const second = viewInFog(renderer, atmosphere, shared)
      second.camera.position.set(300, 8000, 0)
      second.camera.rotation.x = -0.7
      const alone = [await first.draw(FRAMES), await second.draw(FRAMES)]
      for (const view of [first, second]) view.node.accumulates = false
      await first.draw()
      await second.draw()
      for (const view of [first, second]) view.node.accumulates = true
      const views = [first, second]
      renderer.setSize(10, 22, false)
      for (const view of views) await view.draw()
      renderer.setSize(viewSize.width, viewSize.height, false)
      let together: Picture[] = []
      for (let i = 0; i < FRAMES; i++) {
        await nextFrame()
        together = []
        for (const view of views) {
          together.push(await drawToFloat(renderer, () => view.render()))
        }
      }
      const apart = alone.map((picture, i) => difference(picture, together[i]))
      const between = difference(alone[0], alone[1])
      t.note(
        `apart by ${apart.map(value => value.toFixed(4)).join(', ')}; views ${between.toFixed(2)}`
      )
      expectTrue(between > 0.1, `the two views differ by only ${between}`)
      for (const value of apart) expectTrue(value < 0.02, `pictures are apart by ${value}`)
      second.dispose()
    }),
  { backends: ['webgpu'] }
)

gpuTest(
  'leaves no memory behind',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const objects = countObjects(renderer)
    const atmosphere = onGround()
    const light = new CloudLightTable()
    const round = async (): Promise<string> => {
      // A leak does not need the whole bake.
      const noise = new SparseNoise(1)
      const precipitation = precipitationShafts()
      const layers = new CloudLayers([{ ...fog, precipitation: { rate: 1 } }])
      const view = new CloudView(renderer, atmosphere, layers, { noise, light, precipitation })
      await view.draw(2)
      renderer.setSize(12, 7, false)
      view.node.quality = 'ultra'
      await view.draw()
      renderer.setSize(viewSize.width, viewSize.height, false)
      view.dispose()
      noise.dispose()
      await finishWork(renderer)
      return `${JSON.stringify(renderer.info.memory)}, objects ${JSON.stringify(objects)}`
    }
    const before = await round()
    const after = await round()
    expectTrue(after === before, `before ${before}\nafter ${after}`)
    light.dispose()
    atmosphere.dispose()
  },
  // Counted by three, as in `atmosphere/lifecycle`, which WebGL runs.
  { backends: ['webgpu'] }
)

gpuTest(
  'lightning, droplets, crystals, drops, a gauge and wet ground leave no memory behind',
  async t => {
    const renderer = await t.createRenderer({ width: 12, height: 7 })
    const objects = countObjects(renderer)
    const atmosphere = onGround()
    const noise = new SparseNoise()
    const layers = new CloudLayers([{ ...fog, topAltitude: 5000, precipitation: { rate: 1 } }])
    const round = async (): Promise<string> => {
      const crystals = iceCrystals()
      const light = new DropletLightTable({ crystals })
      const drops = raindrops()
      const precipitation = precipitationShafts({ drops })
      const view = new CloudView(renderer, atmosphere, layers, { noise, light, precipitation })
      const storm = lightning(view.node)
      const gauge = new PrecipitationGauge(view.node)
      const ground = new Mesh(new BoxGeometry(400, 1, 400), new MeshStandardNodeMaterial())
      Object.assign(ground.material, wetSurface(new SurfaceWater()))
      view.scene.add(ground)
      storm.strike({ at: new Vector3(0, 0, -4000) })
      await view.draw(3)
      expectTrue(storm.isFlashing, 'no flash')
      gauge.update(renderer, view.camera.position)
      while (gauge.isReading) await nextFrame()
      ground.geometry.dispose()
      ground.material.dispose()
      for (const each of [gauge, storm, view, light, crystals, drops]) each.dispose()
      await finishWork(renderer)
      return `${JSON.stringify(renderer.info.memory)}, objects ${JSON.stringify(objects)}`
    }
    const before = await round()
    const after = await round()
    expectTrue(after === before, `before ${before}\nafter ${after}`)
    noise.dispose()
    atmosphere.dispose()
  },
  // On WebGL the same classes free what they make; its shaders take long to compile.
  { backends: ['webgpu'] }
)
