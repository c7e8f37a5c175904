import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene, type Mesh } from 'three'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 96, height: 64 }

/** Heights above the ground [m], and pitch [rad]: stones and crowns end within the first two pictures, crowns and waves within the third. */
const VIEWS = [
  { longitude: 1, latitude: 47, height: 60, pitch: -0.25 },
  { longitude: 0.494, latitude: 46.35, height: 300, pitch: -0.3 },
  { longitude: 1.6848, latitude: 46.15, height: 1500, pitch: -0.5 }
]

gpuTest('tiles far away look the same by a material of less code, at its borders too', async t => {
  const renderer = await t.createRenderer({ ...SIZE, reversedDepthBuffer: true })
  renderer.highPrecision = true
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const { ellipsoid } = atmosphere
  const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), { pageMemory: 40 })
  const sun = new SunDirectionalLight(atmosphere)
  const scene = new Scene()
  scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 1, 1e9)
  const axes = new Matrix4()
  const counts = (): number[] =>
    [terrain, ...(terrain.children as Mesh[])].map(
      mesh => (mesh as unknown as typeof terrain).geometry.instanceCount
    )
  let far = 0
  for (const { longitude, latitude, height, pitch } of VIEWS) {
    const ground = terrain.heightAt(longitude, latitude)
    ellipsoid.geodeticToECEF({ longitude, latitude, height: ground + height }, camera.position)
    camera.quaternion.setFromRotationMatrix(ellipsoid.localYUpFrame(camera.position, axes))
    camera.rotateX(pitch)
    camera.updateMatrixWorld()
    const up = ellipsoid.surfaceNormal(camera.position)
    atmosphere.sunDirection = up.clone().addScaledVector(up.clone().cross(camera.up), 1)
    terrain.update(renderer, camera, Infinity)
    const split = await t.render(renderer, scene, camera, SIZE)
    const parts = counts()
    // With a material that somebody has changed all tiles have all code.
    const { userData } = terrain.material
    terrain.material.userData = {}
    const whole = await t.render(renderer, scene, camera, SIZE)
    const [near, ...none] = counts()
    terrain.material.userData = userData
    if (none.some(count => count !== 0)) throw new Error(`${none.join(', ')} tiles are left`)
    if (near !== parts.reduce((sum, count) => sum + count, 0)) throw new Error('tiles were lost')
    far += Math.min(...parts.map(count => Math.min(count, 1)))
    let most = 0
    for (let i = 0; i < split.data.length; i++) {
      most = Math.max(most, Math.abs(split.data[i] - whole.data[i]) / (whole.data[i] + 1e-3))
    }
    t.note(`${height} m: ${parts.join(', ')} tiles, pixels differ by ${(100 * most).toFixed(2)} %`)
    if (most > 0.02) throw new Error(`pixels differ by ${(100 * most).toFixed(2)} %`)
  }
  if (far === 0) throw new Error('no picture has tiles of all kinds')
  terrain.dispose()
})
