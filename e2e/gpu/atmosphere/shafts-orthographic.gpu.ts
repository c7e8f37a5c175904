import type { AirOccluder } from '@welkin/atmosphere'
import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'
import { float } from 'three/tsl'
import { drawForward, drawToFloat } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'
import { addBox, addTowers, secondCamera, stage, stageSize as size } from '../harness/shaft-stage'

gpuTest(
  'takes from an orthographic camera what it takes from a narrow perspective one',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    addTowers(set, new Matrix4())
    const cameras = [
      new OrthographicCamera(-0.02, 0.02, 0.01, -0.01, 1, 1e6),
      new PerspectiveCamera(0.01, size.width / size.height, 1, 1e6)
    ]
    for (const [label, target] of [
      ['sky', new Vector3(70, 600, -600)],
      ['tower', new Vector3(60, 300, -600)]
    ] as const) {
      const losses: number[] = []
      for (const camera of cameras) {
        camera.position.set(0, 2, 0)
        camera.lookAt(target)
        camera.updateMatrixWorld()
        const { shafts, pipeline, dispose } = secondCamera(set, renderer, camera)
        const draw = async (): Promise<number> => {
          await nextFrame()
          const picture = await drawToFloat(renderer, () => pipeline.render())
          return picture.at(size.width / 2, size.height / 2)[1]
        }
        await draw()
        const shadowed = await draw()
        shafts.enabled = false
        losses.push(1 - shadowed / (await draw()))
        dispose()
      }
      t.note(`${label}: ${losses.map(part => part.toFixed(5)).join(', ')} of the light is lost`)
      expectTrue(losses[1] > 1e-3, `${label}: a tower casts a shadow`)
      expectClose(losses[0], losses[1], { relative: 0.01, absolute: 1e-4 }, label)
    }
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'takes from a wide orthographic picture what its parallel rays cross',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    const { scene, atmosphere } = set
    addBox(scene, [0, 100, -650], [2000, 400, 100]).castShadow = false
    const half = { x: 400, y: 225 }
    const camera = new OrthographicCamera(-half.x, half.x, half.y, -half.y, 1, 1e6)
    camera.position.y = 300
    camera.updateMatrixWorld()
    const { shafts, pipeline, dispose } = secondCamera(set, renderer, camera)
    const post = (): Promise<Picture> => drawToFloat(renderer, () => pipeline.render())
    const forward = (): Promise<Picture> => drawForward(renderer, scene, camera, atmosphere)
    const wall = 90
    const occluders: AirOccluder[] = [
      { castInto: () => ({ transmittance: () => () => float(0) }) },
      {
        castInto: () => ({
          transmittance: () => place => place.positionWorld().x.greaterThan(wall).select(0, 1)
        })
      }
    ]
    for (const draw of [post, forward]) {
      if (draw === forward) atmosphere.add(shafts)
      const drawn: Picture[] = []
      for (const occluder of occluders) {
        shafts.add(occluder)
        for (let i = 0; i < 2; i++) {
          await nextFrame()
          drawn[occluders.indexOf(occluder)] = await draw()
        }
        shafts.remove(occluder)
      }
      shafts.enabled = false
      await nextFrame()
      const [dark, walled, lit] = [...drawn, await draw()]
      shafts.enabled = true
      // Sky above, and a box below.
      for (const y of [4, 10, size.height - 5]) {
        for (let x = 0; x < size.width; x += 3) {
          const east = ((x + 0.5) / size.width - 0.5) * 2 * half.x
          // A pixel takes its light from those around that are marched.
          if (Math.abs(east - wall) < (8 * half.x) / size.width) continue
          const [all, none, here] = [lit, dark, walled].map(picture => picture.at(x, y)[1])
          const label = `${draw.name} at ${x}, ${y}`
          expectTrue(none < 0.999 * all, `${label}: light is lost, ${none} of ${all} is left`)
          expectClose((all - here) / (all - none), east > wall ? 1 : 0, { absolute: 0.02 }, label)
        }
      }
    }
    dispose()
    set.dispose()
  },
  { backends: ['webgpu'] }
)

gpuTest(
  'has at each place of a wide orthographic picture the shadow map as a narrow one there',
  async t => {
    const renderer = await t.createRenderer(size)
    const set = stage(renderer, 15)
    addTowers(set, new Matrix4())
    const half = { x: 400, y: 225 }
    const wide = new OrthographicCamera(-half.x, half.x, half.y, -half.y, 1, 1e6)
    const narrow = new OrthographicCamera(-0.02, 0.02, 0.01, -0.01, 1, 1e6)
    const pictures = [wide, narrow].map(camera => secondCamera(set, renderer, camera))
    const middle = new Vector3(0, 350, 0)
    for (const camera of [wide, narrow]) camera.rotation.y = 0.5
    for (const { shafts } of pictures) shafts.quality = 'reference'
    const lossesOf = async (index: number, camera: OrthographicCamera): Promise<Picture[]> => {
      const { shafts, pipeline } = pictures[index]
      camera.updateMatrixWorld()
      const drawn: Picture[] = []
      for (const enabled of [true, true, false]) {
        shafts.enabled = enabled
        await nextFrame()
        drawn.push(await drawToFloat(renderer, () => pipeline.render()))
      }
      return drawn.slice(1)
    }
    wide.position.copy(middle)
    const [shadowed, lit] = await lossesOf(0, wide)
    const errors: number[] = []
    const losses: number[] = []
    for (const [x, y] of [
      [4, 20],
      [18, 16],
      [32, 14],
      [40, 24],
      [50, 20],
      [60, 28]
    ]) {
      narrow.position.set(((x + 0.5) / size.width - 0.5) * 2 * half.x, 0, 0)
      narrow.position.applyEuler(narrow.rotation).add(middle)
      narrow.position.y -= ((y + 0.5) / size.height - 0.5) * 2 * half.y
      const [there, litThere] = await lossesOf(1, narrow)
      const [a, b] = [there, litThere].map(picture => picture.at(32, 18)[1])
      losses.push(1 - a / b)
      errors.push(Math.abs(shadowed.at(x, y)[1] / lit.at(x, y)[1] - a / b))
    }
    t.note(`lost ${losses.map(part => part.toFixed(4)).join(', ')}`)
    t.note(`apart ${errors.map(part => part.toFixed(4)).join(', ')}`)
    const [least, most] = [Math.min(...losses), Math.max(...losses)]
    expectTrue(most - least > 5e-3, 'shadows differ from place to place')
    expectTrue(Math.max(...errors) < 0.1 * (most - least), `${Math.max(...errors)} apart`)
    for (const each of [...pictures, set]) each.dispose()
  },
  { backends: ['webgpu'] }
)
