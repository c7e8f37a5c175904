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
  'normals 2 m away are drawn as the CPU has them, within 0.5°',
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
    const normal = new Vector3()
    const point = new Vector3()
    let worst = 0
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
      const draw = (node: Node<'vec3'>) => {
        material.fragmentNode = vec4(node, 1)
        material.needsUpdate = true
        return t.render(renderer, scene, camera, SIZE)
      }
      const positions = await draw(positionView)
      const normals = await draw(drawnNormal)
      for (let y = 0; y < SIZE.height; y++) {
        for (let x = 0; x < SIZE.width; x++) {
          const [viewX, viewY, viewZ] = positions.at(x, y)
          if (viewZ >= 0) continue
          point.set(viewX, viewY, viewZ).applyQuaternion(camera.quaternion).add(camera.position)
          const place = ellipsoid.ecefToGeodetic(point)
          terrain.normalAt(place.longitude, place.latitude, normal)
          steepest = Math.max(steepest, normal.angleTo(ellipsoid.surfaceNormal(point)))
          point.fromArray([...normals.at(x, y)]).applyQuaternion(camera.quaternion)
          worst = Math.max(worst, normal.angleTo(point))
          count++
        }
      }
    }
    const degrees = (angle: number): string => ((angle * 180) / Math.PI).toFixed(3)
    t.note(`${count} pixels, within ${degrees(worst)}°, on slopes up to ${degrees(steepest)}°`)
    terrain.dispose()
    if (count < 0.99 * PLACES.length * SIZE.width * SIZE.height)
      throw new Error(`only ${count} pixels of ground`)
    if (steepest < 0.1) throw new Error('all places are level')
    if (worst > Math.PI / 360) throw new Error(`normals are ${degrees(worst)}° off`)
  },
  { backends: ['webgpu'] }
)
