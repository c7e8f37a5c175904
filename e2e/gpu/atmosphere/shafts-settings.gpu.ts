import type { LightShaftsOptions } from '@welkin/atmosphere'
import { drawForward } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { countCompilations, countObjects, nextFrame } from '../harness/graphics'
import { addBox, expectSame, stage, stageSize as size } from '../harness/shaft-stage'

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
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'frees its textures',
  async t => {
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
    t.note(
      `${least} B of textures, ${most} with a volume, ${off} while it is off, ${after} after it`
    )
    expectTrue(most > least + 1e6, 'the volume takes memory')
    expectTrue(off === most && again === most, 'as much while they are off')
    expectTrue(after <= least, 'all of it is freed')
    dispose()
  },
  { backends: ['webgpu'] }
)
