import { Atmosphere, AtmosphereShell } from '@welkin/atmosphere'
import { PerspectiveCamera, Scene } from 'three'
import { drawForward, drawToFloat, expectLight, relativeDifferences } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const size = { width: 32, height: 18 }

function expectSame(a: Picture, b: Picture, label: string): void {
  const most = relativeDifferences(a, b).at(-1)!
  // Volumes lie elsewhere in a larger atlas: texture coordinates round differently.
  expectTrue(most < 1e-4, `${label}: a pixel differs by ${most}`)
}

gpuTest(
  'atmospheres that share tables draw what each would alone, and outlast each other',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(60, size.width / size.height, 1, 1e6)
    camera.position.y = 10
    camera.updateMatrixWorld()
    const draw = async (atmosphere: Atmosphere, label: string): Promise<Picture> => {
      const picture = await drawForward(renderer, new Scene(), camera, atmosphere)
      expectLight(picture, label)
      return picture
    }
    const alone = [30, 4].map(elevation => new Atmosphere().setSunAngles(elevation, 20))
    const expected: Picture[] = []
    for (const atmosphere of alone) {
      expected.push(await draw(atmosphere, 'alone'))
      atmosphere.dispose()
    }
    const before = renderer.info.memory.textures
    const high = new Atmosphere().setSunAngles(30, 20)
    const { tables } = high
    const low = new Atmosphere({ tables }).setSunAngles(4, 20)
    for (let frame = 0; frame < 2; frame++) {
      expectSame(await draw(high, 'high'), expected[0], 'the high sun')
      expectSame(await draw(low, 'low'), expected[1], 'the low sun')
    }
    expectTrue(tables.version === 1, `${tables.version} bakes, not one for both`)
    high.dispose()
    expectSame(await draw(low, 'low'), expected[1], 'the low sun, after the other was disposed of')
    expectTrue(tables.version === 1, `${tables.version} bakes after the other was disposed of`)
    expectSame(await draw(high, 'high'), expected[0], 'the high sun, used again')
    low.dispose()
    expectSame(
      await draw(high, 'high'),
      expected[0],
      'the high sun, after the other was disposed of'
    )
    high.dispose()
    const left = renderer.info.memory.textures
    expectTrue(left <= before, `${left} textures are left, where ${before} were`)
  },
  // Who has a table is decided without a backend.
  { backends: ['webgpu'] }
)

gpuTest(
  'an atmosphere that is used again has room for its sun beside other sources',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera()
    camera.position.y = 10
    camera.updateMatrixWorld()
    const [never, once] = [false, true].map(isDisposed => {
      const atmosphere = new Atmosphere()
      atmosphere.update(renderer, camera)
      if (isDisposed) atmosphere.dispose()
      atmosphere.update(renderer, camera)
      const { tables } = atmosphere
      tables.addSource({})
      const { height } = tables.atlas.target
      atmosphere.dispose()
      return height
    })
    expectTrue(once === never, `an atlas of ${once} rows, where ${never} are needed`)
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'a shell shares the tables of an atmosphere that is not its sun',
  async t => {
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(60, size.width / size.height, 0.1, 100)
    camera.position.z = 2.5
    camera.updateMatrixWorld()
    const atmosphere = new Atmosphere({ luminanceScale: 3e-4 })
    const { parameters, tables } = atmosphere
    await atmosphere.bake(renderer)
    const draw = async (shell: AtmosphereShell): Promise<Picture> => {
      const scene = new Scene().add(shell)
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      expectLight(picture, 'shell')
      return picture
    }
    const own = new AtmosphereShell(parameters, 1)
    const expected = await draw(own)
    expectTrue(Math.max(...expected.data) > 0.01, 'the shell is black')
    own.dispose()
    const shell = new AtmosphereShell(parameters, 1, { tables })
    // Half floats of another bake, and another scale in the colours.
    const most = relativeDifferences(await draw(shell), expected).at(-1)!
    expectTrue(most < 1e-3, `with the tables of an atmosphere a pixel differs by ${most}`)
    expectTrue(tables.version === 1, `${tables.version} bakes`)
    atmosphere.dispose()
    expectTrue(tables.version === 1, 'the tables went with the atmosphere')
    await draw(shell)
    shell.dispose()
    expectTrue(tables.data === null, 'the tables outlast all who use them')
  },
  { backends: ['webgpu'] }
)
