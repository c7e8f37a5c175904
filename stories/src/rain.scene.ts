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
import { FLIGHT_SECONDS, travel } from './moving/travel'
import { ViewChange } from './moving/ViewChange'
import { FIELD_OF_VIEW, VIEWS, type View } from './rainViews'
import { changeOf, createRenderer, drawSettled, exposureOf, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

/** Frames after which a still has settled. */
const FRAMES = 4

/** Most layers of a view: views take turns while the scene runs. */
const MOST_LAYERS = 2

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
  const viewOf = ({ view }: RainArgs): View => VIEWS[view]
  const camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 4e5)
  const placeCamera = (moved: PerspectiveCamera): void => {
    const { pitch, heading } = viewOf(current)
    moved.position.set(0, 60, 0)
    moved.rotation.set(MathUtils.degToRad(pitch), MathUtils.degToRad(-heading), 0, 'YXZ')
  }
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  travel(undefined, camera, placeCamera, 0)
  const numbers = () => {
    const { sun, exposure, rate, virgaDepth, freezingLevel } = current
    const { azimuth } = viewOf(current)
    return { sun, exposure, azimuth, rate, virgaDepth, freezingLevel }
  }
  const change = new ViewChange<View, ReturnType<typeof numbers>>(viewOf(current), numbers())
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sun, sky } = air
  const { pipeline, color, depth } = air.post!
  atmosphere.add(planetGround())
  const preset = viewOf(current).clouds
  // #region rain
  // #shown const preset = 'shower'
  // #shown const layers = cloudPreset(preset)
  const layers = cloudPreset(preset, MOST_LAYERS) // #hidden
  const layer = layers.at(0)
  layer.precipitation = { rate: 12 } // mm/h; at any time

  const drops = raindrops({ rate: 12 }) // rainbows; leave them out, and there are none
  const medium = precipitationShafts({ drops })
  const node = clouds(color, depth, camera, atmosphere, layers, { precipitation: medium })
  pipeline.outputNode = node
  // #endregion
  Object.assign(sun.shadow, { shadowNode: cloudShadow(node, shadow(sun)) })
  cloudSkyLight(sky, node)
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
  }
  node.time = 0

  const isOther = changeOf()
  /** Shows the change of views as far as it has come. */
  const show = (): void => {
    const { shown, part } = change
    const { sun: elevation, azimuth, exposure, ...fall } = change.numbers
    if (isOther(shown)) {
      atmosphere.place(shown.place)
      layers.copy(cloudPreset(shown.clouds))
      layer.set({ ...shown.layer, coverage: shown.coverage })
      full = [...layers].map(({ coverage }) => coverage)
    }
    full.forEach((coverage, i) => (layers.at(i).coverage = coverage * part))
    atmosphere.setSunAngles(elevation, azimuth)
    renderer.toneMappingExposure = exposureOf(exposure)
    layer.precipitation = { ...shown.fall, ...fall }
  }
  /** Shares of the sky that the layers of the view cover. */
  let full: number[] = []
  show()

  const draw = (): void => {
    const seconds = elapsed()
    explorer?.update(seconds)
    if (change.update(seconds)) show()
    air.render()
  }
  const handle = storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply(before) {
      const isView = before.view !== current.view
      if (isView) {
        const own = viewOf(current).args
        Object.assign(current, own)
        handle.onArgs?.(own)
        travel(explorer, camera, placeCamera, FLIGHT_SECONDS)
        change.go(viewOf(current), numbers(), explorer ? FLIGHT_SECONDS : 0)
      } else change.set(numbers())
      show()
    },
    draw,
    warmUp: () => drawSettled(current.frame ? FRAMES : 0, draw),
    dispose() {
      node.dispose()
      drops.dispose()
      air.dispose()
    }
  })
  return handle
}
