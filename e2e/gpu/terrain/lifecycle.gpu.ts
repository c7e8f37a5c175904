import { Atmosphere } from '@welkin/atmosphere'
import { Terrain, terrainView } from '@welkin/terrain'
import { Matrix4, PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import { WaveHeights } from '../../bench/cracksGround'
import type { GpuContext } from '../harness/context'
import { gpuTest } from '../harness/gpu-test'
import type { Picture } from '../harness/picture'

const SIZE = { width: 64, height: 48 }

/** Rough ground that looks alike everywhere, from 300 m above it. */
async function stage(t: GpuContext): Promise<{
  renderer: WebGPURenderer
  scene: Scene
  camera: PerspectiveCamera
  make: () => Terrain
}> {
  const renderer = await t.createPlanetRenderer(SIZE)
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const heights = new WaveHeights()
  const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 1, 1e8)
  const place = { longitude: 12, latitude: 47, height: heights.highest + 300 }
  atmosphere.ellipsoid.geodeticToECEF(place, camera.position)
  const axes = atmosphere.ellipsoid.localYUpFrame(camera.position, new Matrix4())
  camera.quaternion.setFromRotationMatrix(axes)
  camera.rotateX(-0.9)
  camera.updateMatrixWorld()
  const make = (): Terrain => {
    const terrain = new Terrain(atmosphere, heights, { pageMemory: 20, seaLevel: -Infinity })
    terrain.material.lights = false
    return terrain
  }
  return { renderer, scene: new Scene(), camera, make }
}

/** Pixels of a picture, RGB. */
const pixels = (picture: Picture): number[][] =>
  Array.from({ length: picture.width * picture.height }, (_, i) =>
    picture.at(i % picture.width, Math.floor(i / picture.width))
  )

const isLike = (pixel: readonly number[], color: readonly number[]): boolean =>
  color.every((value, i) => Math.abs(pixel[i] - value) < 0.02)

gpuTest(
  'a terrain that is disposed of leaves no texture and no geometry, and is drawn anew as it was',
  async t => {
    const { renderer, scene, camera, make } = await stage(t)
    const { memory } = renderer.info
    /** Picture of a terrain, once it is disposed of again. */
    const live = async (terrain: Terrain): Promise<number[][]> => {
      scene.add(terrain)
      const before = memory.textures
      terrain.update(renderer, camera, Infinity)
      const picture = pixels(await t.render(renderer, scene, camera, SIZE))
      if (memory.textures <= before) throw new Error('a terrain has no textures')
      scene.remove(terrain)
      terrain.dispose()
      await t.render(renderer, scene, camera, SIZE)
      return picture
    }
    const terrain = make()
    const first = await live(terrain)
    // What is left now is the atmosphere's.
    const before = { ...memory }
    const second = await live(terrain)
    await live(make())
    for (const kind of ['textures', 'geometries'] as const) {
      t.note(`${kind}: ${before[kind]}, then ${memory[kind]}`)
      if (memory[kind] > before[kind])
        throw new Error(`${memory[kind] - before[kind]} ${kind} are left`)
    }
    const worst = Math.max(...first.map((pixel, i) => Math.abs(pixel[0] - second[i][0])))
    if (worst > 1e-5) throw new Error(`the second picture differs by ${worst}`)
  },
  // Counted by three, as in `atmosphere/lifecycle`, which WebGL runs.
  { backends: ['webgpu'] }
)

gpuTest(
  'views of a terrain show its levels, its tiles, and which pages are there',
  async t => {
    const { renderer, scene, camera, make } = await stage(t)
    const terrain = make()
    scene.add(terrain)
    const draw = async (
      view: 'levels' | 'tiles' | 'pages',
      pages: number,
      size = SIZE
    ): Promise<number[][]> => {
      terrain.material.colorNode = terrainView(view)
      terrain.material.needsUpdate = true
      terrain.camera = camera
      terrain.update(renderer, camera, pages)
      // Another camera than the terrain's: it brings no further pages.
      terrain.camera = new PerspectiveCamera()
      const picture = await t.render(renderer, scene, camera, size)
      return pixels(picture).filter(([red, green, blue]) => red + green + blue > 0)
    }
    const missing = await draw('pages', 0)
    const red = missing.filter(pixel => isLike(pixel, [0.7, 0.06, 0.04])).length
    if (red < 0.9 * missing.length)
      throw new Error(`only ${red} of ${missing.length} pixels are red`)
    const there = await draw('pages', Infinity)
    const green = there.filter(pixel => isLike(pixel, [0.1, 0.5, 0.15])).length
    if (green !== there.length) throw new Error(`only ${green} of ${there.length} pixels are green`)
    const colors = (view: number[][]): number =>
      new Set(
        view.map(pixel =>
          pixel
            .slice(0, 3)
            .map(value => value.toFixed(3))
            .join()
        )
      ).size
    const levels = colors(await draw('levels', Infinity))
    const tiles = colors(await draw('tiles', Infinity))
    t.note(`${levels} levels and ${tiles} tiles in ${there.length} pixels`)
    if (levels < 2 || levels > 8) throw new Error(`${levels} levels are in view`)
    if (tiles <= 2 * levels) throw new Error(`${tiles} tiles of ${levels} levels are in view`)
    terrain.material.wireframe = true
    const large = { width: 16 * SIZE.width, height: 16 * SIZE.height }
    const lines = (await draw('levels', Infinity, large)).length / (large.width * large.height)
    if (lines < 0.02 || lines > 0.6) throw new Error(`a wireframe covers ${lines} of the picture`)
    terrain.dispose()
  },
  { backends: ['webgpu'] }
)
