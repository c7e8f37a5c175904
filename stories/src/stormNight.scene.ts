import { NightLightProbe, planetGround, stars } from '@welkin/atmosphere'
import { cloudPreset, clouds, cloudSkyLight, lightning } from '@welkin/clouds'
import { MathUtils, PerspectiveCamera, Scene, Vector3 } from 'three'
import { Air } from './air'
import { STILL_QUALITY } from './clouds/still'
import { Explorer } from './moving/Explorer'
import { FLIGHT_SECONDS, travel } from './moving/travel'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'

/** Frames after which a still has settled. */
const FRAMES = 5

/** Distance of the flash of a still [m]. */
const DISTANCE = 17_500

/** Time over which a still gathers a flash's light [s]. */
const EXPOSURE = 0.5

/** Heights of the camera, and pitches at which it looks at the storm. */
export const VIEWS = {
  ground: { label: 'From the ground', altitude: 200, pitch: 16 },
  aeroplane: { label: 'From an aeroplane', altitude: 7000, pitch: -4 }
} as const

export interface StormArgs extends RendererArgs {
  view: keyof typeof VIEWS
  flashes: boolean
  /** Flashes a minute. */
  rate: number
  gentle: boolean
  /** [stops] */
  exposure: number
}

/** A thunderstorm by night. */
export async function createStorm(
  canvas: HTMLCanvasElement,
  args: StormArgs
): Promise<SceneHandle<StormArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL)
  const scene = new Scene()
  const camera = new PerspectiveCamera(62, 1, 10, 2e6)
  const placeCamera = (moved: PerspectiveCamera): void => {
    const { altitude, pitch } = VIEWS[current.view]
    moved.position.set(0, altitude, 0)
    moved.rotation.set(MathUtils.degToRad(pitch), 0, 0)
  }
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
  const elapsed = frameClock(args.frame)
  const current = { ...args }
  travel(undefined, camera, placeCamera, 0)
  const air = new Air(renderer, scene, camera, 'post')
  const { atmosphere, sky } = air
  const { pipeline, color, depth } = air.post!
  atmosphere.place({ longitude: 139.571, latitude: 35.995 })
  atmosphere.date = new Date('2026-06-14T14:00:00Z')
  const night = new NightLightProbe(atmosphere)
  atmosphere.add(stars(), planetGround())
  scene.add(night)
  // #region lightning
  const node = clouds(color, depth, camera, atmosphere, cloudPreset('cumulonimbus'))
  pipeline.outputNode = node
  cloudSkyLight(sky, node)
  cloudSkyLight(night, node) // #hidden
  const storm = lightning(node, { rate: 6 }) // flashes a minute
  scene.add(storm.light) // lights the ground
  storm.addEventListener('thunder', ({ distance, duration }) => {
    console.debug(`thunder from ${distance / 1000} km, for ${duration} s`) // play your sound
  })
  storm.enabled = false // until people have been asked: flashes may harm them
  // #endregion
  if (args.frame) {
    node.quality = STILL_QUALITY
    node.field.bake(renderer)
    // One flash that stays: time stands still at its end.
    node.time = 0
    storm.set({ rate: 0, limit: null, exposure: EXPOSURE, time: 0, enabled: true })
    storm.addEventListener('strike', () => (storm.time = EXPOSURE))
    storm.strike({ kind: 'ground', at: new Vector3(300, 0, -DISTANCE) })
  }

  const apply = (): void => {
    const { flashes, rate, gentle, exposure } = current
    atmosphere.luminanceScale = 1e-4 * 2 ** exposure
    if (!current.frame) storm.set({ enabled: flashes, rate, limit: gentle ? 0.3 : null })
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
    apply(before) {
      apply()
      if (before.view !== current.view) travel(explorer, camera, placeCamera, FLIGHT_SECONDS)
    },
    draw,
    warmUp: () => drawSettled(current.frame ? FRAMES : 0, draw),
    dispose() {
      storm.dispose()
      node.dispose()
      air.dispose()
    }
  })
}
