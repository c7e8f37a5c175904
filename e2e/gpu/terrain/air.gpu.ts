import {
  aerialPerspectiveFog,
  airAtVertices,
  Atmosphere,
  lightAtVertices,
  SkyLightProbe,
  SunDirectionalLight,
  type FineMaterial
} from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const SIZE = { width: 96, height: 64 }
const PLACE = { longitude: 0.494, latitude: 46.35 }

gpuTest(
  'air and light at the vertices of the ground are those at its pixels, within 1 %',
  async t => {
    const renderer = await t.createRenderer({ ...SIZE, reversedDepthBuffer: true })
    renderer.highPrecision = true
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
    const found = { air: new Differences(), light: new Differences() }
    // Towards the sun, whose glow the air has, away from it, and the light at the edge of the night.
    for (const [height, pitch, heading, elevation] of [
      [2, -2, 180, 4],
      [1000, -12, 170, 35],
      [9000, -4, 180, 6],
      [4e5, -25, 180, 5],
      [4e5, -25, 0, 2]
    ]) {
      atmosphere.setSunAngles(elevation, 180)
      camera.position.y = ground + height
      camera.rotation.set((pitch * Math.PI) / 180, (-heading * Math.PI) / 180, 0, 'YXZ')
      camera.near = height / 20
      camera.updateProjectionMatrix()
      camera.updateMatrixWorld()
      terrain.update(renderer, camera, Infinity)
      const draw = async (atVertices: FineMaterial): Promise<Picture> => {
        const none = { airAtVertices: undefined, lightAtVertices: undefined }
        Object.assign(terrain.material, none, atVertices)
        terrain.material.needsUpdate = true
        return t.render(renderer, scene, camera, SIZE)
      }
      const atPixels = await draw({})
      if (heading === 180 || height < 1e5) found.air.add(await draw({ airAtVertices }), atPixels)
      found.light.add(await draw({ lightAtVertices }), atPixels)
    }
    for (const [name, { worst, sum, count }] of Object.entries(found)) {
      t.note(
        `${name}: ${count} pixels, mean ${((100 * sum) / count).toFixed(3)} %, at most ${(100 * worst).toFixed(2)} %`
      )
      if (count < 10_000) throw new Error(`only ${count} pixels of ground`)
      if (worst === 0) throw new Error(`${name}: both pictures are one`)
      if (worst > 0.01) throw new Error(`the ${name} differs by ${worst}`)
      if (sum / count > 0.001) throw new Error(`the ${name} differs by ${sum / count} in the mean`)
    }
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)

/** Differences of pictures, in parts of a pixel's mean. */
class Differences {
  worst = 0
  sum = 0
  count = 0

  add(found: Picture, right: Picture): void {
    for (let row = 0; row < SIZE.height; row++) {
      for (let column = 0; column < SIZE.width; column++) {
        const [a, b] = [found, right].map(picture => picture.at(column, row))
        const total = b[0] + b[1] + b[2]
        if (total === 0) continue
        const off = Math.max(...[0, 1, 2].map(i => Math.abs(a[i] - b[i]))) / (total / 3)
        this.worst = Math.max(this.worst, off)
        this.sum += off
        this.count++
      }
    }
  }
}
