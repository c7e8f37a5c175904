import { planetGround, raindrops } from '@welkin/atmosphere'
import {
  cloudPreset,
  clouds,
  cloudShadow,
  cloudSkyLight,
  precipitationShafts
} from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { shadow } from 'three/tsl'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { Explorer } from './moving/Explorer'
import { FIELD_OF_VIEW, VIEWS, type View } from './rainViews'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

/** Frames after which a still has settled. */
const FRAMES = 4

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
  const camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 4e5)
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
