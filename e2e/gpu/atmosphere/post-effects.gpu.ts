import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import {
  BoxGeometry,
  Mesh,
  MeshStandardMaterial,
  PerspectiveCamera,
  PlaneGeometry,
  Scene,
  SphereGeometry
} from 'three'
import { builtinAOContext, float, pass, vec4 } from 'three/tsl'
import { Node, NodeUpdateType, RenderPipeline, type WebGPURenderer } from 'three/webgpu'
import { recipes } from 'virtual:recipes'
import {
  FragmentPass,
  outputs,
  tableTarget
} from '../../../packages/atmosphere/src/tables/FragmentPass'
import type { Vec4 } from '../../../packages/atmosphere/src/tsl-types'
import { drawToFloat, expectLight } from '../harness/atmosphere'
import { expectClose, expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'
import type { Picture } from '../harness/picture'

const size = { width: 64, height: 36 }
const names = [
  'GTAO',
  'bloom',
  'depth of field',
  'FXAA',
  'SMAA',
  'TRAA',
  'TAAU',
  'motion blur',
  'SSR'
]
/** Frames that are drawn: TRAA has a history, three's velocities a frame before. */
const FRAMES = 3
/** Rows of the floor beside the box, and in the open before it. */
const CORNER = 25
const OPEN = 34

/** Box and metal ball on a floor, before a low sun and in its light. */
class Stage {
  readonly scene = new Scene()
  readonly camera = new PerspectiveCamera(60, size.width / size.height, 0.1, 1e4)
  readonly atmosphere = new Atmosphere()
  readonly sun = new SunDirectionalLight(this.atmosphere, 50)
  readonly sky = new SkyLightProbe(this.atmosphere)
  readonly #ball: Mesh

  constructor() {
    const matte = new MeshStandardMaterial({ color: 0x888888, roughness: 1 })
    const metal = new MeshStandardMaterial({ color: 0xcccccc, metalness: 1, roughness: 0.1 })
    const floor = new Mesh(new PlaneGeometry(400, 400).rotateX(-Math.PI / 2), matte)
    const box = new Mesh(new BoxGeometry(4, 3, 2), matte)
    box.position.set(0, 1.5, -2)
    this.#ball = new Mesh(new SphereGeometry(1, 24, 16), metal)
    this.#ball.position.set(4, 1, 0)
    this.scene.add(floor, box, this.#ball, this.sun, this.sun.target, this.sky)
    this.camera.position.set(0, 2, 8)
    this.camera.updateMatrixWorld()
    this.look(20)
  }

  /** @param azimuth - Azimuth of the sun, 0 before the camera [°]. */
  look(azimuth: number): void {
    this.atmosphere.setSunAngles(15, azimuth)
  }

  /** Pipeline of a recipe, by its index. */
  prepare(index: number, renderer: WebGPURenderer) {
    const { scene, camera, atmosphere } = this
    return recipes[index]({ renderer, scene, camera, atmosphere })
  }

  /** Turns the camera and moves the ball, for velocities. */
  move(frame: number): void {
    this.#ball.position.x = 4 + 0.2 * frame
    this.camera.rotation.y = 0.02 * frame
    this.camera.updateMatrixWorld()
  }

  /** Draws some frames of a recipe, in motion or not, of which the last is read back. */
  async draw(renderer: WebGPURenderer, pipeline: RenderPipeline, moves: boolean): Promise<Picture> {
    let picture: Picture | undefined
    for (let i = 0; i < FRAMES; i++) {
      if (moves) this.move(i)
      await nextFrame()
      picture = await drawToFloat(renderer, () => pipeline.render())
    }
    return picture!
  }
}

/** Part of the numbers of two pictures that differ by more than a hundredth. */
function difference(a: Picture, b: Picture): number {
  const apart = a.data.filter((value, i) => Math.abs(value - b.data[i]) > 0.01 * (value + 1e-3))
  return apart.length / a.data.length
}

gpuTest(
  "the README's recipes for three's post effects draw light, no pixel that is not finite, and an effect",
  async t => {
    const renderer = await t.createRenderer(size)
    const stage = new Stage()
    expectTrue(recipes.length === names.length, `${recipes.length} recipes, ${names.length} names`)
    const plain = stage.prepare(0, renderer)
    plain.scenePass.contextNode = null
    const without = await stage.draw(renderer, plain.pipeline, true)
    for (const [i, name] of names.entries()) {
      const { pipeline } = stage.prepare(i, renderer)
      const drawn = await stage.draw(renderer, pipeline, true)
      expectLight(drawn, name)
      const lit = drawn.data.filter((value, k) => k % 4 < 3 && value > 1e-3).length
      const all = 3 * size.width * size.height
      expectTrue(lit > 0.9 * all, `${name}: light in ${lit} of ${all} numbers only`)
      const changed = difference(drawn, without)
      t.note(`${name} ${(100 * changed).toFixed(1)} %`)
      expectTrue(changed > 0.002, `${name} changes ${100 * changed} % of the picture`)
      pipeline.dispose()
    }
    plain.pipeline.dispose()
    stage.atmosphere.dispose()
  }
)

/** Mean green light in a row, before the box. */
function lightIn(picture: Picture, row: number): number {
  const columns = Array.from({ length: 17 }, (_, i) => 24 + i)
  return columns.reduce((sum, x) => sum + picture.at(x, row)[1], 0) / columns.length
}

gpuTest(
  "the README's ambient occlusion dims the light of the sky in corners, and no sunlight",
  async t => {
    const renderer = await t.createRenderer(size)
    const stage = new Stage()
    stage.look(180)
    const plain = new RenderPipeline(renderer)
    plain.outputNode = pass(stage.scene, stage.camera, { samples: 0 })
    /** Light in the corner and in the open, of one light, with the recipe over that without. */
    const dimming = async (light: 'sun' | 'sky'): Promise<number[]> => {
      stage.sun.visible = light === 'sun'
      stage.sky.visible = light === 'sky'
      const { scenePass } = stage.prepare(0, renderer)
      const occluded = new RenderPipeline(renderer)
      occluded.outputNode = scenePass
      const after = await stage.draw(renderer, occluded, false)
      const before = await stage.draw(renderer, plain, false)
      occluded.dispose()
      return [CORNER, OPEN].map(row => lightIn(after, row) / lightIn(before, row))
    }
    const sun = await dimming('sun')
    const [corner, open] = await dimming('sky')
    t.note(`sky ${corner.toFixed(3)} in the corner, ${open.toFixed(3)} in the open`)
    expectClose(sun, [1, 1], { absolute: 2e-3 }, 'sunlight')
    expectTrue(corner < 0.93, `the sky's light in the corner is ${corner} of that without`)
    expectTrue(open > 0.95, `the sky's light in the open is ${open} of that without`)
    plain.dispose()
    stage.atmosphere.dispose()
  },
  { backends: ['webgpu'] }
)

/** Ambient occlusion that counts how often it is drawn. */
class CountedOcclusion extends Node<'float'> {
  draws = 0

  constructor() {
    super('float')
    this.updateBeforeType = NodeUpdateType.RENDER
  }

  override updateBefore(): undefined {
    this.draws++
  }

  override setup(): Node {
    return float(0.5)
  }
}

// Else three would draw the scene for it, in the middle of a render of the same scene.
gpuTest('tables that are drawn within a pass take none of its ambient occlusion', async t => {
  const renderer = await t.createRenderer({ width: 1, height: 1 })
  const occlusion = new CountedOcclusion()
  const { value } = builtinAOContext(occlusion) as unknown as { value: object }
  const { contextNode } = renderer as unknown as { contextNode: { value: object } }
  Object.assign(contextNode.value, value)
  const table = tableTarget('Test', 1, 1, 2)
  const filling = new FragmentPass(
    'Test',
    outputs<[Vec4, Vec4]>(2, all => {
      for (const each of all) each.assign(vec4(1))
    })
  )
  filling.render(renderer, table)
  expectTrue(occlusion.draws === 0, `occlusion was drawn ${occlusion.draws} times for a table`)
  const scene = new Scene().add(new Mesh(new BoxGeometry(), new MeshStandardMaterial()))
  const camera = new PerspectiveCamera()
  camera.position.z = 2
  renderer.render(scene, camera)
  expectTrue(occlusion.draws === 1, `occlusion was drawn ${occlusion.draws} times for a box`)
  filling.dispose()
  table.dispose()
})
