import { Atmosphere, SkyLightProbe, SunDirectionalLight } from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { Vegetation } from '../../../stories/src/terrain/vegetation/Vegetation'
import { gpuTest } from '../harness/gpu-test'

/** A clearing in woods. */
const PLACE = { longitude: 0.494, latitude: 46.35 }

gpuTest(
  'grass, flowers and trees stand on the ground of their frame',
  async t => {
    const size = { width: 96, height: 54 }
    const renderer = await t.createPlanetRenderer(size)
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    atmosphere.setSunAngles(35, 200)
    const terrain = new Terrain(atmosphere, new MountainHeights({ seed: 513 }), {
      resolution: 8,
      pageMemory: 8
    })
    const scene = new Scene()
    const sun = new SunDirectionalLight(atmosphere)
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    const camera = new PerspectiveCamera(55, size.width / size.height, 0.1, 1e7)
    camera.position.y = terrain.heightAt(PLACE.longitude, PLACE.latitude) + 1.7
    camera.rotation.set(-0.15, 0.38, 0, 'YXZ')
    camera.updateMatrixWorld()
    terrain.update(renderer, camera, Infinity)
    const bare = await t.render(renderer, scene, camera, size)
    const plants = new Vegetation(renderer, terrain)
    scene.add(plants)
    plants.update(camera, 0, Infinity)
    const grown = await t.render(renderer, scene, camera, size)
    let changed = 0
    let green = 0
    for (let y = 0; y < size.height; y++) {
      for (let x = 0; x < size.width; x++) {
        const [before, after] = [bare.at(x, y), grown.at(x, y)]
        if (!after.every(Number.isFinite)) throw new Error(`no number at ${x}, ${y}`)
        if (Math.abs(after[1] - before[1]) < 0.02 * before[1]) continue
        changed++
        if (after[1] > after[0] && after[1] > after[2]) green++
      }
    }
    const pixels = size.width * size.height
    t.note(`${((100 * changed) / pixels).toFixed(0)} % of the picture are plants`)
    if (changed < 0.2 * pixels) throw new Error(`only ${changed} pixels have plants`)
    if (green < 0.5 * changed)
      throw new Error(`only ${green} of ${changed} pixels of plants are green`)
    plants.dispose()
    terrain.dispose()
  },
  // Its shaders are those of one path; a page of WebGL takes a minute for them in software.
  { backends: ['webgpu'] }
)
