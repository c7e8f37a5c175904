import {
  aerialPerspectiveFog,
  airAtVertices,
  Atmosphere,
  SkyLightProbe,
  SunDirectionalLight
} from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const SIZE = { width: 96, height: 64 }
const PLACE = { longitude: 0.494, latitude: 46.35 }

gpuTest(
  'air at the vertices of the ground is that at its pixels, within 1 %',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    const options = { resolution: 12, pageMemory: 20 }
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), options)
    const scene = new Scene()
    const sun = new SunDirectionalLight(atmosphere)
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 0.1, 1e8)
    const ground = terrain.heightAt(PLACE.longitude, PLACE.latitude)
    let isAtVertices = false
    const show = (atVertices: boolean): void => {
      isAtVertices = atVertices
      Object.assign(terrain.material, { airAtVertices: atVertices ? airAtVertices : undefined })
      terrain.material.needsUpdate = true
    }
    show(true)
    let worst = 0
    let sum = 0
    let count = 0
    // Towards the sun, whose glow the air has, and away from it.
    for (const [height, pitch, heading, elevation] of [
      [2, -2, 180, 4],
      [1000, -12, 170, 35],
      [9000, -4, 180, 6],
      [4e5, -25, 180, 5]
    ]) {
      atmosphere.setSunAngles(elevation, 180)
      camera.position.y = ground + height
      camera.rotation.set((pitch * Math.PI) / 180, (-heading * Math.PI) / 180, 0, 'YXZ')
      camera.near = height / 20
      camera.updateProjectionMatrix()
      camera.updateMatrixWorld()
      terrain.update(renderer, camera, Infinity)
      const draw = (): Promise<Picture> => t.render(renderer, scene, camera, SIZE)
      // Every other view begins as the one before has ended, with shaders that are compiled.
      const first = await draw()
      const wasAtVertices = isAtVertices
      show(!isAtVertices)
      const second = await draw()
      const [atVertices, atPixels] = wasAtVertices ? [first, second] : [second, first]
      for (let row = 0; row < SIZE.height; row++) {
        for (let column = 0; column < SIZE.width; column++) {
          const found = atVertices.at(column, row)
          const right = atPixels.at(column, row)
          const total = right[0] + right[1] + right[2]
          if (total === 0) continue
          const off = Math.max(...[0, 1, 2].map(i => Math.abs(found[i] - right[i]))) / (total / 3)
          worst = Math.max(worst, off)
          sum += off
          count++
        }
      }
    }
    t.note(
      `${count} pixels, mean ${((100 * sum) / count).toFixed(3)} %, at most ${(100 * worst).toFixed(2)} %`
    )
    if (count < 10_000) throw new Error(`only ${count} pixels of ground`)
    if (worst === 0) throw new Error('both pictures are one')
    if (worst > 0.01) throw new Error(`the air differs by ${worst}`)
    if (sum / count > 0.001) throw new Error(`the air differs by ${sum / count} in the mean`)
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)
