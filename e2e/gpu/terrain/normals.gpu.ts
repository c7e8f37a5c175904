import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { positionView, vec4 } from 'three/tsl'
import type { Node } from 'three/webgpu'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 48, height: 32 }

/** A slope, a place a tenth of a metre from a pole, and the antimeridian. */
const PLACES = [
  [1, 47],
  [70, 89.999999],
  [180, -12]
] as const

/** Angle of view [°]: a wider one has three times as many pages, which are drawn in software. */
const FOV = 15

gpuTest(
  'ground and normals 2 m away are drawn as the CPU has them, within 1 cm and 0.5°',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere({ frame: 'ecef' })
    const { ellipsoid } = atmosphere
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 1 }), {
      seaLevel: -Infinity,
      // Slopes half as fine as by default: pages are drawn in software.
      pageMemory: 36
    })
    const { material } = terrain
    const drawnNormal = (material as unknown as { ground: Node<'vec3'> }).ground
    const scene = new Scene().add(terrain)
    const camera = new PerspectiveCamera(FOV, SIZE.width / SIZE.height, 0.1, 1e9)
    // From above all normals point to the camera: two components tell the third, and depth where in its pixel's ray the ground is.
    material.fragmentNode = vec4(drawnNormal.xy, positionView.z, 1)
    const normal = new Vector3()
    const point = new Vector3()
    let worst = 0
    let farthest = 0
    let steepest = 0
    let count = 0
    for (const [longitude, latitude] of PLACES) {
      const height = terrain.heightAt(longitude, latitude) + 2
      ellipsoid.geodeticToECEF({ longitude, latitude, height }, camera.position)
      camera.quaternion.setFromRotationMatrix(
        ellipsoid.localYUpFrame(camera.position, new Matrix4())
      )
      camera.rotateX(-Math.PI / 2)
      camera.updateMatrixWorld()
      terrain.update(renderer, camera, Infinity)
      const picture = await t.render(renderer, scene, camera, SIZE)
      for (let y = 0; y < SIZE.height; y++) {
        for (let x = 0; x < SIZE.width; x++) {
          const [normalX, normalY, viewZ] = picture.at(x, y)
          if (viewZ >= 0) continue
          point.set((2 * x + 1) / SIZE.width - 1, 1 - (2 * y + 1) / SIZE.height, 0.5)
          point.applyMatrix4(camera.projectionMatrixInverse).multiplyScalar(viewZ / point.z)
          point.applyQuaternion(camera.quaternion).add(camera.position)
          const place = ellipsoid.ecefToGeodetic(point)
          const ground = terrain.heightAt(place.longitude, place.latitude)
          farthest = Math.max(farthest, Math.abs(place.height - ground))
          terrain.normalAt(place.longitude, place.latitude, normal)
          steepest = Math.max(steepest, normal.angleTo(ellipsoid.surfaceNormal(point)))
          point.set(normalX, normalY, Math.sqrt(1 - normalX ** 2 - normalY ** 2))
          point.applyQuaternion(camera.quaternion)
          worst = Math.max(worst, normal.angleTo(point))
          count++
        }
      }
    }
    const degrees = (angle: number): string => ((angle * 180) / Math.PI).toFixed(3)
    t.note(
      `${count} pixels, within ${(1000 * farthest).toFixed(1)} mm and ${degrees(worst)}°, on slopes up to ${degrees(steepest)}°`
    )
    terrain.dispose()
    if (count < 0.99 * PLACES.length * SIZE.width * SIZE.height)
      throw new Error(`only ${count} pixels of ground`)
    if (steepest < 0.1) throw new Error('all places are level')
    if (!(farthest < 0.01)) throw new Error(`the drawn ground is ${farthest} m off`)
    if (!(worst < Math.PI / 360)) throw new Error(`normals are ${degrees(worst)}° off`)
  },
  // On WebGL `terrain/flat` holds what is drawn to 1 cm.
  { backends: ['webgpu'] }
)
