import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { farTiles, MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene } from 'three'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 64, height: 40 }

/** A view with tiles of all kinds [°, m]. */
const PLACE = { longitude: 0.494, latitude: 46.35 }
const HEIGHT = 150

gpuTest(
  'tiles far away look the same by materials of less code, at borders too',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    const { ellipsoid } = atmosphere
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), {
      resolution: 8,
      pageMemory: 8,
      far: farTiles
    })
    const sun = new SunDirectionalLight(atmosphere)
    const scene = new Scene()
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 1, 1e9)
    // Some of the near ground is under water.
    terrain.set({ seaLevel: terrain.heightAt(PLACE.longitude, PLACE.latitude) - 70 })
    const height = terrain.heightAt(PLACE.longitude, PLACE.latitude) + HEIGHT
    ellipsoid.geodeticToECEF({ ...PLACE, height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, new Matrix4()))
    camera.rotateX(-0.3)
    camera.updateMatrixWorld()
    const up = ellipsoid.surfaceNormal(camera.position)
    atmosphere.sunDirection = up.clone().addScaledVector(up.clone().cross(camera.up), 1)
    const counts = (): number[] =>
      [terrain, ...(terrain.children as Terrain[])].map(mesh => mesh.geometry.instanceCount)
    terrain.update(renderer, camera, Infinity)
    const split = await t.render(renderer, scene, camera, SIZE)
    const parts = counts()
    // With a material that somebody has changed all tiles have all code.
    terrain.material.userData = {}
    const whole = await t.render(renderer, scene, camera, SIZE)
    const [near, ...none] = counts()
    let most = 0
    for (const [i, value] of whole.data.entries()) {
      most = Math.max(most, Math.abs(split.data[i] - value) / (value + 1e-3))
    }
    t.note(`${parts.join(', ')} tiles, pixels differ by ${(100 * most).toFixed(2)} %`)
    terrain.dispose()
    if (Math.min(...parts) === 0) throw new Error(`not all kinds of tiles: ${parts.join(', ')}`)
    if (near !== parts.reduce((sum, count) => sum + count) || none.some(count => count > 0)) {
      throw new Error(`${near} tiles, and ${none.join(', ')}`)
    }
    if (most > 0.02) throw new Error(`pixels differ by ${(100 * most).toFixed(2)} %`)
  },
  { backends: ['webgpu'] }
)
