import {
  aerialPerspective,
  Atmosphere,
  exposureFor,
  groundShadow,
  lightShafts,
  terrainShadow
} from '@welkin/atmosphere'
import { MountainHeights, Terrain } from '@welkin/terrain'
import { PerspectiveCamera, Scene } from 'three'
import { shadow } from 'three/tsl'
import { Air } from './air'
import { prepareShadow } from './globe/sunShadow'
import { createRenderer, exposureOf, type RendererArgs, type SceneHandle } from './scene'
import { storyHandle } from './storyHandle'
import { GroundCamera } from './terrain/GroundCamera'

export interface MountainShadowsArgs extends RendererArgs {
  /** Part of the light that shadowed air loses; 1 is physical, 0 has no shafts. */
  strength: number
  /** Aerosol of the air: 1 is clear, 6 thick haze. */
  turbidity: number
  /** Elevation of the sun [degrees]. */
  elevation: number
  /** Its azimuth, clockwise from north [degrees]. */
  azimuth: number
  /** [stops], 0 as `exposureFor` says. */
  exposure: number
}

/** Place of the world's origin [°], and the camera's height above the ground there [m]. */
const ORIGIN = { longitude: 1.1, latitude: 47.08 }
const HEIGHT = 250

/** Direction of the camera, clockwise from north, and above the horizontal [°]. */
const HEADING = 58
const PITCH = 3

/** Fewer cells and texels in a still: a software renderer draws it. */
const STILL = { resolution: 16, pageMemory: 100, pagesPerFrame: 4 }

/** Shadows of mountains tens of kilometres away, in the haze and on the ground, where no shadow map reaches. */
export async function createMountainShadows(
  canvas: HTMLCanvasElement,
  args: MountainShadowsArgs
): Promise<SceneHandle<MountainShadowsArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(40, 1, 1, 1e7)
  const current = { ...args }
  const atmosphere = new Atmosphere()
  atmosphere.place(ORIGIN)
  const air = new Air(renderer, scene, camera, 'post', atmosphere)
  const { sun, post } = air
  if (post === undefined) throw new Error('createMountainShadows: there must be a post effect')
  const terrain = new Terrain(
    atmosphere,
    new MountainHeights({ seed: 513 }),
    args.frame ? STILL : {}
  )
  terrain.castShadow = terrain.receiveShadow = true
  scene.add(terrain)
  prepareShadow(sun)

  const ground = new GroundCamera(camera, canvas, terrain, args.frame)
  const { picture, depth, pipeline } = post
  // #region mountain shadows
  // #shown const terrain = new Terrain(atmosphere, new MountainHeights())
  const mountains = groundShadow(atmosphere, terrain) // of 100 km about the camera
  const shafts = lightShafts(atmosphere, camera, sun).add(mountains) // in the air
  // And on the ground.
  Object.assign(sun.shadow, { shadowNode: terrainShadow(mountains, sun, shadow(sun)) })
  // #shown const picture = scenePass.getTextureNode() // without its air
  pipeline.outputNode = aerialPerspective(picture, depth, camera, atmosphere, { shafts })
  // #endregion

  camera.position.y = terrain.heightBelow(camera.position) + HEIGHT
  const degree = Math.PI / 180
  camera.rotation.set(PITCH * degree, -HEADING * degree, 0, 'YXZ')

  let haze = NaN
  const apply = (): void => {
    const { strength, turbidity, elevation, azimuth, exposure } = current
    shafts.strength = strength
    if (turbidity !== haze) atmosphere.parameters.set({ turbidity })
    haze = turbidity
    atmosphere.setSunAngles(elevation, azimuth)
    renderer.toneMappingExposure = exposureOf(exposure)
  }
  apply()
  if (args.frame) await atmosphere.bake(renderer) // exposure is that of the tables

  const draw = (): void => {
    ground.update(sun)
    atmosphere.luminanceScale = 1e-4 * exposureFor(atmosphere, camera)
    pipeline.render()
  }

  return storyHandle<MountainShadowsArgs>({
    renderer,
    scene,
    camera,
    explorer: ground.explorer,
    current,
    apply,
    draw,
    dispose() {
      shafts.dispose()
      mountains.dispose()
      terrain.dispose()
      air.dispose()
    }
  })
}
