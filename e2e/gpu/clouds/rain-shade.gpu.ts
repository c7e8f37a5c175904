import type { AirOccluder } from '@welkin/atmosphere'
import {
  CloudLayers,
  CloudLightTable,
  CloudNoise,
  cloudAirShadow,
  clouds,
  precipitationShafts
} from '@welkin/clouds'
import { Vector3 } from 'three'
import { uniform } from 'three/tsl'
import { RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { drawToFloat } from '../harness/atmosphere'
import { CloudView, coarse, fog, middle, onGround, viewSize } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { stage, stageSize as size } from '../harness/shaft-stage'

/** Sun in the north, before the camera [°]: rain shines where it hides the sun. */
const SUN = 25

/** A layer over the camera that is seen through, and from which it rains everywhere. */
const layer = {
  ...fog,
  baseAltitude: 1500,
  topAltitude: 1800,
  density: 1e-7,
  precipitation: { rate: 0.2, share: 1, freezingLevel: 9000 }
}

/** Distance that parts near and far casters [m]. */
const BETWEEN = 2500

/** Frames that light is the mean of: those of a block of pixels. */
const FRAMES = 4

/** Spectrum of one value. */
const all4 = (value: number): [number, number, number, number] => [value, value, value, value]

gpuTest(
  "loses rain's sunlight where something shades it, near and far",
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, SUN)
    const { shafts, camera, air, depth, atmosphere } = set
    // Next to no air: what one sees is rain in sunlight.
    atmosphere.parameters.set({
      rayleighScattering: all4(1e-12),
      mieScattering: all4(0),
      mieExtinction: all4(1e-12),
      groundAlbedo: all4(0)
    })
    const [light, noise, precipitation] = [
      new CloudLightTable(),
      new CloudNoise(),
      precipitationShafts()
    ]
    const layers = new CloudLayers([layer])
    const node = clouds(air, depth, camera, atmosphere, layers, {
      // Rain falls unevenly: few steps would find another share of it far away in each frame.
      quality: { ...coarse, layerSteps: 32 },
      noise,
      light,
      precipitation
    })
    node.time = 0
    node.accumulates = false
    await node.bake(renderer)
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = node
    camera.position.y = 50
    camera.lookAt(new Vector3(0, 0.3, -1).add(camera.position))
    camera.updateMatrixWorld()
    const [litNear, litFar] = [uniform(1), uniform(1)]
    const caster: AirOccluder = {
      castInto: () => ({
        transmittance: () => place => place.distance.greaterThan(BETWEEN).select(litFar, litNear)
      })
    }
    shafts.add(caster, cloudAirShadow(node))
    /** A picture, with what shades all that is near, or far. */
    const draw = async (isDark: { near?: boolean; far?: boolean }): Promise<Picture> => {
      litNear.value = isDark.near ? 0 : 1
      litFar.value = isDark.far ? 0 : 1
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    }
    /** Light of the middle third of the picture. */
    const sumOf = (picture: Picture): number => {
      let sum = 0
      for (let y = size.height / 3; y < (2 * size.height) / 3; y++) {
        for (let x = Math.ceil(size.width / 3); x < (2 * size.width) / 3; x++) {
          sum += picture.at(x, y)[1]
        }
      }
      return sum
    }
    await draw({}) // shadows of clouds are drawn now
    /** Mean light over frames: each finds rain at other places, but those of one mean are those of another. */
    const lightOf = async (isDark: { near?: boolean; far?: boolean }): Promise<number> => {
      node.passes.viewRays.frame.reset()
      let light = 0
      for (let frame = 0; frame < FRAMES; frame++) light += sumOf(await draw(isDark)) / FRAMES
      return light
    }
    const sum = await lightOf({})
    const lossTo = async (isDark: { near?: boolean; far?: boolean }): Promise<number> =>
      sum - (await lightOf(isDark))
    const all = await lossTo({ near: true, far: true })
    const [near, far] = [await lossTo({ near: true }), await lossTo({ far: true })]
    const parts = [near / all, far / all, all / sum].map(part => part.toFixed(3))
    t.note(`near shade takes ${parts[0]}, far ${parts[1]} of what both take, ${parts[2]} of all`)
    expectTrue(near > 0.1 * all && far > 0.1 * all, `near ${near}, far ${far} of ${all}`)
    // What rain scatters more than once stays.
    expectTrue(all > 0.03 * sum, `all shade takes ${all} of ${sum}`)
    // What is lost to one shade or the other is lost to both.
    expectClose(near + far, all, { relative: 0.04 }, 'near and far')
    for (const owned of [node, pipeline, light, noise, set]) owned.dispose()
  },
  // The same look-ups as in clouds, which WebGL draws, too.
  { backends: ['webgpu'] }
)

/** A thin layer over the camera. */
const thin = { ...fog, baseAltitude: 1500, topAltitude: 1800, density: 1e-4 }

/** Rain from all of it, even under weak columns. */
const rain = { rate: 20, share: 1, freezingLevel: 9000, streaks: 0 }

/** Names of the passes that a renderer draws, and count of the pipelines that it makes, from now on. */
function watch(renderer: WebGPURenderer): { passes: string[]; pipelines: number } {
  const seen = { passes: [] as string[], pipelines: 0 }
  const render = renderer.render.bind(renderer)
  renderer.render = (...args) => {
    seen.passes.push(args[0].name)
    return render(...args)
  }
  const { device } = renderer.backend as unknown as { device: GPUDevice }
  const create = device.createRenderPipeline.bind(device)
  device.createRenderPipeline = descriptor => {
    seen.pipelines++
    return create(descriptor)
  }
  return seen
}

gpuTest(
  'nothing of rain is drawn while none falls, and it begins and ends within a frame, compiled beforehand',
  async t => {
    const renderer = await t.createRenderer(viewSize)
    const atmosphere = onGround()
    const [noise, light] = [new CloudNoise(), new CloudLightTable()]
    const seen = watch(renderer)
    const show = (precipitation: boolean): CloudView => {
      const medium = precipitation ? precipitationShafts() : undefined
      const shared = { noise, light, precipitation: medium }
      const view = new CloudView(renderer, atmosphere, new CloudLayers([thin]), shared)
      view.node.accumulates = false
      view.camera.position.y = 100
      return view
    }
    const [plain, view] = [show(false), show(true)]
    const { layers } = view.node.field
    const drawn = async (): Promise<{ light: number; passes: number; pipelines: number }> => {
      Object.assign(seen, { passes: [], pipelines: 0 })
      const value = middle(await view.draw())
      const passes = seen.passes.filter(name => name.startsWith('Welkin.CloudsFall')).length
      return { light: value, passes, pipelines: seen.pipelines }
    }
    await view.node.bake(renderer)
    const clear = middle(await plain.draw(2))
    expectTrue((await drawn()).pipelines > 5, 'its passes are compiled at first')
    const dry = await drawn()
    expectTrue(dry.passes === 0, `${dry.passes} passes draw what falls where nothing does`)
    expectClose([dry.light], [clear], { relative: 1e-3 }, 'dry air')

    layers.at(0).precipitation = rain
    const wet = await drawn()
    t.note(`${clear.toPrecision(3)} dry, ${wet.light.toPrecision(3)} in rain`)
    expectTrue(wet.passes === 2, `${wet.passes} passes draw rain`)
    expectTrue(Math.abs(wet.light / clear - 1) > 0.1, 'rain is not seen in its first frame')
    expectTrue(wet.pipelines === 0, `${wet.pipelines} pipelines are made as rain begins`)

    for (const end of [{ precipitation: null }, { precipitation: rain, coverage: 0 }]) {
      layers.at(0).set(end)
      const after = await drawn()
      expectTrue(after.passes === 0 && after.pipelines === 0, `${JSON.stringify(end)}: still drawn`)
    }
    layers.at(0).coverage = 1
    expectTrue((await drawn()).passes === 2, 'it does not rain again')
    view.camera.position.y = 200_000
    expectTrue((await drawn()).passes === 0, 'rain is drawn that is too far away')
    for (const each of [plain, view, noise, light, atmosphere]) each.dispose()
  },
  // It counts pipelines of WebGPU.
  { backends: ['webgpu'] }
)
