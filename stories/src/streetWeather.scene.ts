import type { Vector3 } from 'three'
import { Explorer } from './moving/Explorer'
import { topOf } from './moving/obstacles'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'
import { Street, type StreetWeather } from './street/Street'

export interface StreetArgs extends RendererArgs, StreetWeather {}

/** Time of fall in a still [s], and frames after which it has settled. */
const STILL = { time: 60, frames: 4 }

/** Distance that one keeps from walls [m]. */
const BODY = 0.4

/** Rain and snow around the camera, in a street with lamps. */
export async function createStreet(
  canvas: HTMLCanvasElement,
  args: StreetArgs
): Promise<SceneHandle<StreetArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL, false, true)
  const street = new Street(renderer, args.frame ? STILL.time : null)
  const { scene, camera } = street
  const current = { ...args }
  street.set(current)
  const roofAt = topOf(street.obstacles, BODY)
  const footingAt = (place: Vector3): number => Math.max(roofAt(place), 0)
  const explorer = args.frame ? undefined : new Explorer(camera, canvas, { footingAt })
  const elapsed = frameClock(args.frame)
  await street.atmosphere.bake(renderer)
  const draw = (): void => {
    explorer?.update(elapsed())
    street.render()
  }
  return storyHandle({
    renderer,
    scene,
    camera,
    explorer,
    current,
    apply: () => street.set(current),
    draw,
    warmUp: () => drawSettled(current.frame ? STILL.frames : 0, draw, () => street.exposure),
    dispose: () => street.dispose()
  })
}
