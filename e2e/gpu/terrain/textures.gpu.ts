import {
  aerialPerspectiveFog,
  Atmosphere,
  groundShadow,
  forwardShafts,
  skyBackground,
  SkyLightProbe,
  SunDirectionalLight,
  terrainShadow
} from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudShadow } from '@welkin/clouds'
import { GroundMask, GroundMaps, PageImages, Terrain, type PageRequest } from '@welkin/terrain'
import {
  DataTexture,
  EquirectangularReflectionMapping,
  PerspectiveCamera,
  RenderTarget,
  Scene
} from 'three'
import { CSMShadowNode } from 'three/addons/csm/CSMShadowNode.js'
import { pass } from 'three/tsl'
import { coarse } from '../harness/cloud-view'
import { gpuTest } from '../harness/gpu-test'
import { levelGround } from '../harness/ground'
import { nextFrame } from '../harness/graphics'
import { watchShaders } from '../harness/shaders'

/** Textures that a stage may sample on WebGPU's default limits and on WebGL2. */
const LIMIT = 16

/** Pictures that show nothing. */
class NoPictures extends PageImages {
  imageOf({ side }: PageRequest) {
    return { colors: new Uint8ClampedArray(4 * side ** 2), isWhole: true }
  }

  loadImage() {
    return Promise.resolve()
  }
}

gpuTest(
  'ground with maps, a mask, pictures, and all that shades it samples no more textures than devices have',
  async t => {
    const renderer = await t.createRenderer({ width: 16, height: 16, reversedDepthBuffer: true })
    renderer.highPrecision = true
    renderer.shadowMap.enabled = true
    const atmosphere = new Atmosphere().place({ longitude: 1, latitude: 47 })
    atmosphere.setSunAngles(35, 240)
    const picture = new DataTexture(new Uint8Array([90, 90, 90, 255]), 1, 1)
    picture.needsUpdate = true
    const maps = new GroundMaps({ rock: { albedo: picture, height: picture } }, { size: 16 })
    const area = { west: 0.9, east: 1.1, south: 46.9, north: 47.1 }
    const mask = new GroundMask(picture, { materials: ['rock', 'grass', 'sand'], ...area })
    const options = { resolution: 4, pageMemory: 4, maps, mask, imagery: new NoPictures() }
    const terrain = new Terrain(atmosphere, levelGround, options)
    terrain.receiveShadow = true
    const camera = new PerspectiveCamera(60, 1, 1, 1e7)
    camera.position.y = terrain.heightAt(1, 47) + 50
    camera.updateMatrixWorld()
    const scene = new Scene()
    const sun = new SunDirectionalLight(atmosphere, 200)
    sun.castShadow = true
    sun.shadow.mapSize.setScalar(16)
    const drawn = pass(scene, camera)
    const [color, depth] = [drawn.getTextureNode(), drawn.getTextureNode('depth')]
    const sky = clouds(color, depth, camera, atmosphere, cloudPreset('mixed', 4), {
      quality: coarse
    })
    const mountains = groundShadow(atmosphere, terrain)
    const cascades = new CSMShadowNode(sun, { cascades: 4, maxFar: 400 })
    Object.assign(sun.shadow, {
      shadowNode: cloudShadow(sky, terrainShadow(mountains, sun, cascades))
    })
    atmosphere.add(forwardShafts(atmosphere, camera, sun).add(mountains))
    const around = new DataTexture(new Uint8Array(4 * 8 * 4).fill(255), 8, 4)
    around.mapping = EquirectangularReflectionMapping
    around.needsUpdate = true
    scene.environment = around
    scene.backgroundNode = skyBackground(atmosphere)
    scene.fogNode = aerialPerspectiveFog(atmosphere)
    scene.add(sun, sun.target, new SkyLightProbe(atmosphere), terrain)
    const shaders = watchShaders(renderer)
    await nextFrame()
    renderer.setRenderTarget(new RenderTarget(16, 16))
    renderer.render(scene, camera)
    const ground = shaders.filter(({ name }) => name === 'Welkin.Terrain')
    const most = Math.max(...ground.map(({ textures }) => textures))
    t.note(`${most} textures`)
    if (!(most <= LIMIT)) throw new Error(`the ground samples ${most} textures`)
  },
  { backends: ['webgpu'] }
)
