import { Mesh, PerspectiveCamera, PlaneGeometry, Scene } from 'three'
import { pass } from 'three/tsl'
import { MeshBasicNodeMaterial, RenderPipeline } from 'three/webgpu'
import { stillVelocity } from '../../../stories/src/valley/stillVelocity'
import { drawToFloat } from '../harness/atmosphere'
import { expectTrue } from '../harness/expect'
import { gpuTest } from '../harness/gpu-test'
import { nextFrame } from '../harness/graphics'

/** Pixels along an edge. */
const SIZE = 16

gpuTest(
  'things that stand still move over the screen as the camera does, not as its jitter',
  async t => {
    const renderer = await t.createRenderer({ width: SIZE, height: SIZE })
    const camera = new PerspectiveCamera(90, 1, 0.1, 10)
    const wall = new Mesh(new PlaneGeometry(20, 20), new MeshBasicNodeMaterial())
    wall.position.z = -2
    const scene = new Scene().add(wall)
    const scenePass = pass(scene, camera, { samples: 0 })
    const pipeline = new RenderPipeline(renderer)
    pipeline.outputColorTransform = false
    // Into what a picture can hold.
    pipeline.outputNode = stillVelocity(scenePass.getTextureNode('depth'), camera).mul(0.5).add(0.5)
    const draw = async (): Promise<number[]> => {
      await nextFrame()
      const picture = await drawToFloat(renderer, () => pipeline.render())
      return [0, 1].map(axis => 2 * picture.at(4, 11)[axis] - 1)
    }
    const near = (found: number[], wanted: number[], what: string): void => {
      t.note(`${what}: ${found.map(each => each.toFixed(4)).join(', ')}`)
      const isNear = found.every((each, axis) => Math.abs(each - wanted[axis]) < 2e-3)
      expectTrue(isNear, `${what}: ${found}, not ${wanted}`)
    }
    near(await draw(), [0, 0], 'first')
    camera.setViewOffset(SIZE, SIZE, 0.4, -0.3, SIZE, SIZE)
    near(await draw(), [0, 0], 'jitter alone')
    // At 2 m a shift of 0.2 m is a tenth of the half picture.
    camera.position.set(0.2, -0.1, 0)
    camera.setViewOffset(SIZE, SIZE, -0.2, 0.4, SIZE, SIZE)
    near(await draw(), [-0.1, 0.05], 'after a step')
    near(await draw(), [0, 0], 'after it')
    pipeline.dispose()
    scenePass.dispose()
    wall.geometry.dispose()
    wall.material.dispose()
  }
)
