import { aerialPerspectiveFog, skyBackground, type LightShaftsOptions } from '@welkin/atmosphere'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { drawForward, drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, expectSame, stage, stageSize as size } from '../harness/shaft-stage'

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
  },
  // On WebGL materials take shafts in `everything`, and the post effect in `shafts-maps`.
  { backends: ['webgpu'] }
)

gpuTest(
  'draws cascades before the sky, in the frame in which casters move',
  async t => {
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
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'is turned on and off in materials that stand still, and changes quality',
  async t => {
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
  },
  { backends: ['webgpu'] }
)
