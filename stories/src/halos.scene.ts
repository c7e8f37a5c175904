import { droplets, heightFog, iceCrystals, planetGround, raindrops } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudSkyLight, DropletLightTable } from '@welkin/clouds'
import type { CloudPresetName } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { Explorer } from './moving/Explorer'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

/** Frames after which a still has settled. */
const FRAMES = 4

interface View {
  readonly label: string
  /** Null for mist about the ground. */
  readonly clouds: CloudPresetName | null
  /** Altitude of the camera [m]. */
  readonly altitude: number
  /** Pitch of the camera, which looks north [°]. */
  readonly pitch: number
  /** Vertical field of view [°]; by default 62. */
  readonly lens?: number
  /** Azimuth of the sun: behind the camera or before it [°]. */
  readonly azimuth: 0 | 180
}

/** Skies, and where the camera looks. */
export const VIEWS = {
  glory: {
    label: 'Glory on an even deck',
    clouds: 'overcast',
    altitude: 2600,
    pitch: -38,
    lens: 18,
    azimuth: 180
  },
  cloudbow: {
    label: 'Cloudbow about a glory',
    clouds: 'overcast',
    altitude: 2600,
    pitch: -45,
    lens: 90,
    azimuth: 180
  },
  fogbow: { label: 'Fogbow', clouds: null, altitude: 30, pitch: 12, azimuth: 180 },
  rainbow: { label: 'Rainbow', clouds: null, altitude: 10, pitch: 18, azimuth: 180 },
  halo: { label: 'Halo and sun dogs', clouds: 'cirrus', altitude: 2, pitch: 20, azimuth: 0 }
} as const satisfies Record<string, View>

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
  const camera = new PerspectiveCamera(view.lens ?? 62, 1, 1, 4e5)
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
  const mist = heightFog({ density: 0.004, falloff: 150, droplets: drops })
  const rain = raindrops({ rate: 8 }) // rainbow; mm/h
  const shower = heightFog({ density: rain.extinction, falloff: 250, droplets: rain })
  // #shown atmosphere.add(mist) // or the shower
  // #endregion
  if (view.clouds === null) {
    atmosphere.add(args.view === 'rainbow' ? shower : mist)
    layers.at(0).coverage = 0
  }
  // The thinner a deck is, the more of its light is scattered once; the evener it is, the rounder are its rings.
  if (view.clouds === 'overcast') {
    layers.at(0).set({ density: 0.005, shapeAmount: 0.25, edgeSoftness: 0.6 })
  }
  if (view.clouds === 'cirrus') layers.at(0).set({ coverage: 0.9, density: 0.0015 })
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
