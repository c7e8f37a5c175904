import { droplets, heightFog, iceCrystals, planetGround, raindrops } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudSkyLight, DropletLightTable } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { FIELD_OF_VIEW, VIEWS, type View } from './halosViews'
import { Explorer } from './moving/Explorer'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

/** Frames after which a still has settled. */
const FRAMES = 4

export interface HalosArgs extends RendererArgs {
  view: keyof typeof VIEWS
  /** Elevation of the sun [°]. */
  sun: number
  /** Effective radius of droplets [µm]. */
  dropletRadius: number
  /** Share of crystals with flat faces. */
  regular: number
  /** Share of plates that float level. */
  level: number
  /** [stops] */
  exposure: number
}

/** Bows, rings and halos that droplets and crystals make, with the sun behind one's back or before one. */
export async function createHalos(
  canvas: HTMLCanvasElement,
  args: HalosArgs
): Promise<SceneHandle<HalosArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const view: View = VIEWS[args.view]
  const camera = new PerspectiveCamera(view.lens ?? FIELD_OF_VIEW, 1, 1, 4e5)
  camera.position.y = view.altitude
  camera.rotation.x = MathUtils.degToRad(view.pitch)
  camera.updateMatrixWorld()
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sky } = air
  const { pipeline, color, depth } = air.post!
  atmosphere.add(planetGround())
  const layers = cloudPreset(view.clouds ?? 'fairWeather')
  // #region droplets
  // #shown const layers = cloudPreset('cirrus')
  const crystals = iceCrystals() // halo and sun dogs, in cirrus
  const light = new DropletLightTable({ crystals }) // glory, cloudbow and corona
  const node = clouds(color, depth, camera, atmosphere, layers, { light })
  pipeline.outputNode = node
  cloudSkyLight(sky, node)

  const drops = droplets() // fogbow
  const mist = heightFog({ density: 0.004, falloff: 60, droplets: drops })
  const rain = raindrops({ rate: 8 }) // rainbow; mm/h
  const shower = heightFog({ density: rain.extinction, falloff: 250, droplets: rain })
  // #shown atmosphere.add(mist) // or the shower
  // #endregion
  if (view.clouds === null) {
    atmosphere.add(args.view === 'rainbow' ? shower : mist)
    layers.at(0).coverage = 0
  }
  if (view.layer) layers.at(0).set(view.layer)
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
  }
  node.time = 0

  const apply = (): void => {
    const { sun, dropletRadius, regular, level, exposure } = current
    atmosphere.setSunAngles(sun, view.azimuth)
    renderer.toneMappingExposure = 2 ** exposure
    if (drops.radius !== dropletRadius) {
      drops.radius = dropletRadius
      light.dropletRadius = dropletRadius
    }
    if (crystals.regular !== regular || crystals.level !== level) crystals.set({ regular, level })
  }
  apply()

  const draw = (): void => {
    explorer?.update(elapsed())
    air.render()
  }
  return storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply,
    draw,
    warmUp: () => drawSettled(current.frame ? FRAMES : 0, draw),
    dispose() {
      node.dispose()
      light.dispose()
      crystals.dispose()
      drops.dispose()
      rain.dispose()
      air.dispose()
    }
  })
}
