import { PCFShadowMap, VSMShadowMap } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { quantile } from '../../validate/score'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { addBox, expectSame, stage, stageSize as size } from '../harness/shaft-stage'

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
    // As fine as cascades: edges of coarser texels are elsewhere.
    light.shadow.mapSize.setScalar(2048)
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
  expectTrue(errors < 0.03 * shadows, 'cascades')
})

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
