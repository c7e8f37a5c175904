import { Atmosphere } from '@welkin/atmosphere'
import { Terrain, TerrainHorizon } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { vec3, vec4, positionWorld } from 'three/tsl'
import { WaveHeights } from '../../bench/cracksGround'
import { gpuTest } from '../harness/gpu-test'

const SIZE = { width: 96, height: 54 }
const PLACE = { longitude: 12, latitude: 47 }

/** Frames within which heights come back. */
const FRAMES = 20

gpuTest(
  'what ground hides is left out, and the picture stays',
  async t => {
    const renderer = await t.createPlanetRenderer(SIZE)
    const atmosphere = new Atmosphere()
    atmosphere.place(PLACE)
    const terrain = new Terrain(atmosphere, new WaveHeights(), {
      pageMemory: 20,
      horizon: new TerrainHorizon(),
      seaLevel: -Infinity
    })
    // Each place has its own colour.
    terrain.material.fragmentNode = vec4(positionWorld.mul(vec3(0.013)).fract(), 1)
    const scene = new Scene().add(terrain)
    const camera = new PerspectiveCamera(60, SIZE.width / SIZE.height, 0.2, 1e7)
    camera.position.y = terrain.heightAt(PLACE.longitude, PLACE.latitude) + 2
    camera.updateMatrixWorld()
    terrain.update(renderer, camera, Infinity)
    const whole = await t.render(renderer, scene, camera, SIZE)
    const { inView: all } = terrain.tileCount
    let picture = whole
    for (let frame = 0; frame < FRAMES; frame++) {
      picture = await t.render(renderer, scene, camera, SIZE)
      if (terrain.tileCount.inView < all) break
    }
    const { inView } = terrain.tileCount
    const changed = picture.data.filter((value, i) => Math.abs(value - whole.data[i]) > 1e-3).length
    t.note(`${inView} of ${all} tiles, ${changed} values changed`)
    terrain.dispose()
    if (!(inView < 0.9 * all)) throw new Error('the ground hides nothing')
    if (changed > 0) throw new Error(`${changed} values of the picture changed`)
  },
  { backends: ['webgpu'] }
)
