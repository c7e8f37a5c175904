import { Atmosphere } from '@welkin/atmosphere'
import { Terrain } from '@welkin/terrain'
import { Color, PerspectiveCamera, Scene, Vector3 } from 'three'
import { positionView, vec4 } from 'three/tsl'
import { gpuTest } from '../harness/gpu-test'
import { hills } from '../harness/ground'

const SIZE = { width: 64, height: 48 }

gpuTest('the ground of a flat world is drawn where the CPU finds it, without holes', async t => {
  const renderer = await t.createPlanetRenderer(SIZE)
  const atmosphere = new Atmosphere({ flat: true })
  const options = { resolution: 16, seaLevel: -Infinity, pageMemory: 20 }
  const terrain = new Terrain(atmosphere, hills(512, 60), options)
  terrain.material.fragmentNode = vec4(positionView, 1)
  const scene = new Scene()
  scene.background = new Color(0, 0, 0)
  scene.add(terrain)
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 0.1, 1e9)
  const point = new Vector3()
  let points = 0
  let worstNear = 0
  let worstShare = 0
  for (const [x, z, clearance, pitch] of [
    [0, 0, 2, -90],
    [7312.4, -90_211.7, 2, -90],
    [-254_000, 611_000.3, 2, -90],
    [12, 3400, 2, -35],
    [-5000, 800, 300, -50],
    [0, 0, 9000, -90]
  ]) {
    camera.position.set(x, 0, z)
    camera.position.y = terrain.heightBelow(camera.position) + clearance
    camera.rotation.set((pitch * Math.PI) / 180, 0, 0)
    camera.near = clearance / 20
    camera.updateProjectionMatrix()
    camera.updateMatrixWorld()
    terrain.update(renderer, camera, Infinity)
    const picture = await t.render(renderer, scene, camera, SIZE)
    for (let row = 0; row < SIZE.height; row += 2) {
      for (let column = 0; column < SIZE.width; column += 2) {
        const [viewX, viewY, viewZ] = picture.at(column, row)
        point.set(viewX, viewY, viewZ)
        const distance = point.length()
        if (!(viewZ < 0)) throw new Error(`a hole from ${x}, ${z}, ${clearance} m`)
        point.applyMatrix4(camera.matrixWorld)
        const off = Math.abs(point.y - terrain.heightBelow(point))
        if (distance < 3) worstNear = Math.max(worstNear, off)
        worstShare = Math.max(worstShare, off / distance)
        points++
      }
    }
  }
  t.note(
    `${points} points, ${(1000 * worstNear).toFixed(1)} mm within 3 m, else ${worstShare.toExponential(1)} of their distance`
  )
  if (worstNear > 0.01) throw new Error(`the drawn ground is ${worstNear} m off`)
  if (worstShare > 0.01) throw new Error(`the drawn ground is ${worstShare} of its distance off`)
  terrain.dispose()
})
