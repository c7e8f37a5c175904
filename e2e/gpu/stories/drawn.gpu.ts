import { Mesh, PerspectiveCamera, PlaneGeometry, Scene } from 'three'
import { pass, vec3 } from 'three/tsl'
import { MeshBasicNodeMaterial, RenderPipeline } from 'three/webgpu'
import { drawnOf } from '../../../stories/src/valleyAir'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

gpuTest(
  'nothing is seen of the frame before where a pass that is not cleared draws none',
  async t => {
    const size = { width: 16, height: 16 }
    const renderer = await t.createRenderer(size)
    const camera = new PerspectiveCamera(90, 1, 0.1, 10)
    const material = new MeshBasicNodeMaterial()
    material.colorNode = vec3(0.5, 1, 2)
    const wall = new Mesh(new PlaneGeometry(4, 4), material)
    wall.position.z = -1
    const scene = new Scene().add(wall)
    const scenePass = pass(scene, camera, { samples: 0 })
    Object.assign(scenePass, { autoClearColor: false })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    pipeline.outputNode = drawnOf(scenePass)
    const draw = async () => {
      await nextFrame()
      return drawToFloat(renderer, () => pipeline.render())
    }
    const before = await draw()
    // It covers the left half alone.
    wall.position.x = -2
    const after = await draw()
    const greens = [before, after].map(picture => [4, 12].map(x => picture.at(x, 8)[1]))
    t.note(greens.map(row => row.join(', ')).join('; '))
    expectTrue(Math.min(...greens[0], greens[1][0]) > 0.99, 'the wall is not seen')
    expectTrue(greens[1][1] === 0, `where it was ${greens[1][1]} is seen`)
    pipeline.dispose()
    scenePass.dispose()
    wall.geometry.dispose()
    material.dispose()
  }
)
