import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain, type HeightSource } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene, Vector3 } from 'three'
import { positionView, vec4 } from 'three/tsl'
import { viewerOf } from '../../../packages/terrain/src/tiles/cpu/viewer'
import { noTiles, TileTree } from '../../../packages/terrain/src/tiles/TileTree'
import { DrawnTile } from '../../../packages/terrain/test/DrawnTile'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import { levelGround } from '../harness/ground'
import type { Picture } from '../harness/picture'

const SIZE = { width: 32, height: 24 }

const RESOLUTION = 8
const DETAIL = 1.2

const atmosphere = new Atmosphere({ frame: 'ecef' })
const { ellipsoid } = atmosphere

/** Camera at 2,100 km: triangles are twice as large there, where flat, and morph. */
function highCamera(): PerspectiveCamera {
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 1e5, 1e9)
  camera.position.set(299300.68, -8069237.96, 2614543.46)
  camera.quaternion.set(-0.195150093, -0.353619986, 0.896602531, -0.181585373)
  camera.updateProjectionMatrix()
  camera.updateMatrixWorld()
  return camera
}

/** Draws where in the view each pixel's ground is. */
async function draw(
  t: GpuContext,
  camera: PerspectiveCamera,
  source: HeightSource
): Promise<Picture> {
  const renderer = await t.createPlanetRenderer(SIZE)
  const terrain = new Terrain(atmosphere, source, {
    resolution: RESOLUTION,
    detail: DETAIL,
    seaLevel: -Infinity,
    pageMemory: 6,
    camera: new PerspectiveCamera()
  })
  terrain.material.fragmentNode = vec4(positionView, 1)
  terrain.update(renderer, camera, Infinity)
  const picture = await t.render(renderer, new Scene().add(terrain), camera, SIZE)
  terrain.dispose()
  return picture
}

gpuTest('tiles are drawn where their float64 twins are', async t => {
  const camera = highCamera()
  const picture = await draw(t, camera, levelGround)
  const clearance = ellipsoid.ecefToGeodetic(camera.position).height
  const viewer = viewerOf(camera, camera.position, clearance, 0, new Matrix4(), ellipsoid, 0)
  const tree = new TileTree(ellipsoid, levelGround, 21, DETAIL)
  const { tiles } = tree.select(viewer, 3000, noTiles(), false)
  const drawing = {
    ellipsoid,
    eye: camera.position,
    datum: viewer.datumPoint,
    flatUntil: 2000 + 100 * clearance,
    skirt: 1,
    resolution: RESOLUTION,
    detail: DETAIL,
    ranges: tree.ranges,
    rounding: 0,
    random: () => 0.5,
    heightAt: () => 0
  }
  const drawn = tiles.map(tile => new DrawnTile(tile, drawing))
  const [ray, point] = [new Vector3(), new Vector3()]
  const errors: number[] = []
  for (let y = 0; y < SIZE.height; y++) {
    for (let x = 0; x < SIZE.width; x++) {
      const [viewX, viewY, viewZ] = picture.at(x, y)
      if (!(viewZ < 0)) continue
      // By where it is drawn: vertices lie on a grid of parts of a pixel.
      ray.set(viewX, viewY, viewZ).applyQuaternion(camera.quaternion)
      point.copy(ray).add(camera.position)
      const distance = ray.length()
      ray.divideScalar(distance)
      // Towards the limb lines of sight leave the triangles.
      if (ellipsoid.surfaceNormal(point, point).dot(ray) > -0.3) continue
      const found = drawn.map(tile => (tile.isNear(ray) ? tile.distanceTo(ray) : Infinity))
      errors.push(Math.abs(Math.min(...found) - distance))
    }
  }
  errors.sort((a, b) => a - b)
  const count = errors.length
  const [median, most] = [0.5, 0.9].map(share => errors[Math.floor(share * count)])
  t.note(`${tiles.length} tiles, ${count} pixels, half within ${median} m, 90 % within ${most} m`)
  if (count < 400) throw new Error(`only ${count} pixels of ground`)
  // The rest is beside edges of triangles.
  if (most > 10) throw new Error(`the ground is ${most} m from its twin`)
})

gpuTest(
  'vertices that have moved to others are where these are: no sliver is lost at the edge of the picture',
  async t => {
    const picture = await draw(t, highCamera(), new MountainHeights({ seed: 1 }))
    if (!(picture.at(1, 22)[2] < 0 && picture.at(2, 23)[2] < 0)) throw new Error('no ground')
    if (!(picture.at(1, 23)[2] < 0)) throw new Error('a gap between two tiles')
  },
  { backends: ['webgpu'] }
)
