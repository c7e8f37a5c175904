import { cascadedShadow, CascadedShadowNode } from '@welkin/atmosphere'
import { PCFShadowMap, VSMShadowMap } from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { quantile } from '../../validate/score'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'
import { watchShaders } from '../harness/shaders'
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

gpuTest(
  "reads three's cascades, and those in one map, as it reads one map",
  async t => {
    const renderer = await t.createRenderer(size)
    const pictures: Picture[] = []
    const options = { cascades: 3, maxFar: 3000, lightMargin: 2000 }
    for (const kind of ['map', 'cascades', 'one map']) {
      const { scene, light, draw, shafts, dispose } = stage(renderer, 15)
      // As fine as cascades: edges of coarser texels are elsewhere.
      light.shadow.mapSize.setScalar(2048)
      const tower = addBox(scene, [-100, 200, -600], [150, 500, 60])
      // Not seen itself: its own front is where shadow maps of other texels differ.
      Object.assign(tower.material, { colorWrite: false, depthWrite: false })
      const shadowNode =
        kind === 'cascades' ? new CSMShadowNode(light, options) : cascadedShadow(light, options)
      if (kind === 'cascades' || kind === 'one map') Object.assign(light.shadow, { shadowNode })
      // CSM draws the cascades of a frame where it has put them in the frame before.
      await draw()
      pictures.push(await draw())
      if (kind === 'one map') {
        shafts.enabled = false
        pictures.push(await draw())
      }
      dispose()
    }
    const [map, cascades, oneMap, lit] = pictures
    const apart = (a: Picture, b: Picture): number[] =>
      [...a.data].map((value, i) => Math.abs(value - b.data[i]) / (lit.data[i] + 1e-6))
    const [errors, shadows] = [apart(cascades, map), apart(map, lit)].map(all =>
      quantile(all, 0.98)
    )
    t.note(
      `98 % of pixels differ by less than ${errors.toFixed(4)}, by shadows ${shadows.toFixed(4)}`
    )
    expectTrue(shadows > 0.02, 'the tower casts a shadow')
    expectTrue(errors < 0.03 * shadows, 'cascades')
    const most = Math.max(...apart(oneMap, cascades))
    t.note(`cascades in one map: ${most.toExponential(1)} apart`)
    expectTrue(most < 1e-3, 'cascades in one map')
  },
  // The test of surfaces reads those in one map on both backends.
  { backends: ['webgpu'] }
)

gpuTest(
  "surfaces have the shadows of three's cascades from one map, with one texture in place of four",
  async t => {
    const renderer = await t.createRenderer(size)
    const shaders = watchShaders(renderer)
    const drawn: { picture: Picture; textures: number }[] = []
    for (const makes of [null, CSMShadowNode, CascadedShadowNode]) {
      const { scene, camera, light, dispose } = stage(renderer, 25)
      // Of four cascades, each has some of these towers and their shadows.
      for (const [i, z] of [-25, -70, -150, -260].entries())
        addBox(scene, [24 * i - 30, 0, z], [0.3 * -z, -0.4 * z, 6])
      addBox(scene, [0, -1, -200], [400, 2, 600])
      camera.position.y = 20
      light.castShadow = makes !== null
      light.shadow.mapSize.set(512, 256)
      if (makes) {
        const shadowNode = new makes(light, { cascades: 4, maxFar: 400 })
        Object.assign(light.shadow, { shadowNode })
      }
      const first = shaders.length
      // CSM draws the cascades of a frame where it has put them in the frame before.
      for (let i = 0; i < 2; i++) await drawToFloat(renderer, () => renderer.render(scene, camera))
      const picture = await drawToFloat(renderer, () => renderer.render(scene, camera))
      drawn.push({
        picture,
        textures: Math.max(...shaders.slice(first).map(each => each.textures))
      })
      dispose()
    }
    const [lit, three, one] = drawn
    const share = (a: Picture, b: Picture, part: number): number =>
      a.data.filter((value, i) => Math.abs(value - b.data[i]) > part * value).length / a.data.length
    const shadowed = share(lit.picture, three.picture, 0.5)
    const apart = share(three.picture, one.picture, 0.01)
    t.note(`${(100 * shadowed).toFixed(1)} % in shadow, ${(100 * apart).toFixed(2)} % apart`)
    expectTrue(shadowed > 0.03, `${shadowed} are in shadow`)
    // A texel's place in the atlas is rounded.
    expectTrue(apart < 0.002, `${apart} differ`)
    expectTrue(three.textures - one.textures === 3, `${three.textures}, and ${one.textures}`)
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
