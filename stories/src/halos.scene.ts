import { droplets, heightFog, iceCrystals, planetGround, raindrops } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudSkyLight, DropletLightTable } from '@welkin/clouds'
import type { CloudLayers } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene } from 'three'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { argsOf, FIELD_OF_VIEW, VIEWS, type View } from './halosViews'
import { Explorer } from './moving/Explorer'
import { FLIGHT_SECONDS, travel } from './moving/travel'
import { ViewChange } from './moving/ViewChange'
import { changeOf, createRenderer, drawSettled, exposureOf, frameClock } from './scene'
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

/** Clouds of a view; mist and showers have a clear sky. */
function layersOf({ clouds: name, layer }: View): CloudLayers {
  const layers = cloudPreset(name ?? 'fairWeather')
  layers.at(0).set({ ...layer, ...(name === null && { coverage: 0 }) })
  return layers
}

/** Bows, rings and halos that droplets and crystals make, with the sun behind one's back or before one. */
export async function createHalos(
  canvas: HTMLCanvasElement,
  args: HalosArgs
): Promise<SceneHandle<HalosArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const viewOf = ({ view }: HalosArgs): View => VIEWS[view]
  const camera = new PerspectiveCamera(FIELD_OF_VIEW, 1, 1, 4e5)
  const placeCamera = (moved: PerspectiveCamera): void => {
    const { altitude, pitch } = viewOf(current)
    moved.position.set(0, altitude, 0)
    moved.rotation.set(MathUtils.degToRad(pitch), 0, 0)
  }
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  travel(undefined, camera, placeCamera, 0)
  const numbers = () => {
    const { sun, exposure } = current
    const { azimuth, lens = FIELD_OF_VIEW } = viewOf(current)
    return { sun, exposure, azimuth, lens }
  }
  const change = new ViewChange<View, ReturnType<typeof numbers>>(viewOf(current), numbers())
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sky } = air
  const { pipeline, color, depth } = air.post!
  atmosphere.add(planetGround())
  const layers = layersOf(viewOf(current))
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
  atmosphere.add(mist, shower)
  const density = { mist: mist.density, shower: shower.density }
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
  }
  node.time = 0

  const isOther = changeOf()
  /** Radius of the droplets on show [µm]: another view's has its turn where the old clouds are gone. */
  let dropletRadius = current.dropletRadius
  /** Shows the change of views as far as it has come. */
  const show = (): void => {
    const { regular, level } = current
    const { shown, part } = change
    const { sun, azimuth, exposure, lens } = change.numbers
    if (shown === viewOf(current)) ({ dropletRadius } = current)
    const finished = layersOf(shown)
    if (isOther(shown)) layers.copy(finished)
    layers.at(0).coverage = finished.at(0).coverage * part
    const isClear = shown.clouds === null
    mist.density = isClear && !shown.rains ? density.mist * part : 0
    shower.density = isClear && shown.rains ? density.shower * part : 0
    camera.fov = lens
    camera.updateProjectionMatrix()
    atmosphere.setSunAngles(sun, azimuth)
    renderer.toneMappingExposure = exposureOf(exposure)
    if (drops.radius !== dropletRadius) {
      drops.radius = dropletRadius
      light.dropletRadius = dropletRadius
    }
    if (crystals.regular !== regular || crystals.level !== level) crystals.set({ regular, level })
  }
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
        const own = argsOf(viewOf(current))
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
      light.dispose()
      crystals.dispose()
      drops.dispose()
      rain.dispose()
      air.dispose()
    }
  })
  return handle
}
