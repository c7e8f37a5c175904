import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { farTiles, MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene } from 'three'
import { gpuTest } from '../harness/gpu-test'

gpuTest(
  'no shader is compiled as the camera goes from 2 m to 20,000 km',
  async t => {
    const size = { width: 48, height: 32 }
    const renderer = await t.createPlanetRenderer(size)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    const { ellipsoid } = atmosphere
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), {
      resolution: 8,
      pageMemory: 6,
      far: farTiles
    })
    const sun = new SunDirectionalLight(atmosphere)
    const scene = new Scene()
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    const camera = new PerspectiveCamera(60, size.width / size.height, 0.1, 1e9)
    const axes = new Matrix4()
    const { device } = renderer.backend as unknown as {
      device: Pick<GPUDevice, 'createRenderPipeline' | 'createRenderPipelineAsync'>
    }
    let compiled = 0
    for (const name of ['createRenderPipeline', 'createRenderPipelineAsync'] as const) {
      const create = device[name].bind(device) as (...args: unknown[]) => never
      device[name] = (...args: unknown[]): never => {
        compiled++
        return create(...args)
      }
    }
    const draw = async (height: number, longitude: number): Promise<void> => {
      const ground = terrain.heightAt(longitude, 47)
      ellipsoid.geodeticToECEF(
        { longitude, latitude: 47, height: ground + height },
        camera.position
      )
      camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, axes))
      camera.rotateX(-1)
      camera.near = height / 20
      camera.updateProjectionMatrix()
      camera.updateMatrixWorld()
      await t.render(renderer, scene, camera, size)
    }
    // Pages are drawn by shaders of their own, in the first frames.
    await draw(2, 1)
    await draw(2, 1)
    const first = compiled
    for (let height = 2; height < 2e7; height *= 8) await draw(height, 1 + Math.log(height))
    t.note(`${first} pipelines at first, ${compiled - first} later`)
    if (first === 0) throw new Error('no pipeline was seen')
    if (compiled > first) throw new Error(`${compiled - first} pipelines were compiled on the way`)
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)
