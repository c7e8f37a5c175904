import { planetGround, raindrops } from '@welkin/atmosphere'
import {
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  precipitationShafts
} from '@welkin/clouds'
import type { CloudLayerParameters, CloudPrecipitation, CloudPresetName } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { shadow } from 'three/tsl'
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
  readonly clouds: CloudPresetName
  /** Share of the sky that the first layer covers. */
  readonly coverage: number
  /** Other parameters of that layer, where the preset's are not meant. */
  readonly layer?: Partial<CloudLayerParameters>
  /** Other parameters of what falls. */
  readonly fall?: Partial<CloudPrecipitation>
  /** Azimuth of the sun, clockwise from north [°]. */
  readonly azimuth: number
  /** Azimuth that the camera looks to, clockwise from north [°]. */
  readonly heading: number
  /** Pitch of the camera [°]. */
  readonly pitch: number
  /** Place of the camera [°]. */
  readonly place: { readonly longitude: number; readonly latitude: number }
}

const home = { longitude: 0, latitude: 0 }

/** Weathers, and where the camera looks. */
export const VIEWS = {
  shower: {
    label: 'Shower',
    clouds: 'shower',
    coverage: 0.3,
    azimuth: 260,
    heading: 0,
    pitch: 10,
    place: home
  },
  bow: {
    label: 'Bow in a shower',
    clouds: 'shower',
    coverage: 0.15,
    azimuth: 206,
    heading: 60,
    pitch: 10,
    place: { longitude: 140.6798, latitude: 35.2496 }
  },
  virga: {
    label: 'Virga',
    clouds: 'altocumulus',
    coverage: 0.12,
    layer: { topAltitude: 4400, density: 0.006, weatherScale: 0.6, shapeScale: 0.8 },
    azimuth: 350,
    heading: 60,
    pitch: 20,
    fall: { share: 0.9, streaks: 2 },
    place: { longitude: 20, latitude: 45 }
  },
  snow: {
    label: 'Snow shower',
    clouds: 'snowShower',
    coverage: 0.1,
    azimuth: 280,
    heading: 20,
    pitch: 9,
    place: { longitude: 20, latitude: 45 }
  }
} as const satisfies Record<string, View>

export interface RainArgs extends RendererArgs {
  view: keyof typeof VIEWS
  /** Elevation of the sun [°]. */
  sun: number
  /** [mm/h] */
  rate: number
  /** Depth in which rain evaporates; 0 for none [m]. */
  virgaDepth: number
  freezingLevel: number
  /** [stops] */
  exposure: number
}

/** Shafts of rain and snow under their clouds, seen from afar. */
export async function createRain(
  canvas: HTMLCanvasElement,
  args: RainArgs
): Promise<SceneHandle<RainArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const view: View = VIEWS[args.view]
  const camera = new PerspectiveCamera(62, 1, 1, 4e5)
  camera.position.y = 60
  const { pitch, heading } = view
  camera.rotation.set(MathUtils.degToRad(pitch), MathUtils.degToRad(-heading), 0, 'YXZ')
  camera.updateMatrixWorld()
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sun, sky } = air
  const { pipeline, color, depth } = air.post!
  atmosphere.place(view.place)
  atmosphere.add(planetGround())
  const preset = view.clouds
  // #region rain
  // #shown const preset = 'shower'
  const layers = cloudPreset(preset)
  const layer = layers.at(0)
  layer.precipitation = { rate: 12 } // mm/h; at any time

  const drops = raindrops({ rate: 12 }) // rainbows; leave them out, and there are none
  const medium = precipitationShafts({ drops })
  const node = clouds(color, depth, camera, atmosphere, layers, { precipitation: medium })
  pipeline.outputNode = node
  // #endregion
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
  cloudSkyLight(sky, node)
  layer.set({ ...view.layer, coverage: view.coverage })
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
  }
  node.time = 0

  const apply = (): void => {
    const { sun: elevation, rate, virgaDepth, freezingLevel, exposure } = current
    atmosphere.setSunAngles(elevation, view.azimuth)
    renderer.toneMappingExposure = 2 ** exposure
    layer.precipitation = { ...view.fall, rate, virgaDepth, freezingLevel }
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
      drops.dispose()
      air.dispose()
    }
  })
}
