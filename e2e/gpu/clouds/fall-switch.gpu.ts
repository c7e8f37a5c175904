import { CloudLayers, CloudLightTable, precipitationShafts } from '@welkin/clouds'
import type { WebGPURenderer } from 'three/webgpu'
import { CloudView, fog, middle, onGround, SparseNoise, viewSize } from '../harness/cloud-view'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'

/** A thin layer over the camera. */
const layer = { ...fog, baseAltitude: 1500, topAltitude: 1800, density: 1e-4 }

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
    const [noise, light] = [new SparseNoise(), new CloudLightTable()]
    const seen = watch(renderer)
    const show = (precipitation: boolean): CloudView => {
      const medium = precipitation ? precipitationShafts() : undefined
      const shared = { noise, light, precipitation: medium }
      const view = new CloudView(renderer, atmosphere, new CloudLayers([layer]), shared)
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
