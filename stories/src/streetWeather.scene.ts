import { Explorer } from './moving/Explorer'
import { createRenderer, drawSettled, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { storyHandle } from './storyHandle'
import { Street, type StreetWeather } from './street/Street'

export interface StreetArgs extends RendererArgs, StreetWeather {}

/** Time of fall in a still [s], and frames after which it has settled. */
const STILL = { time: 60, frames: 4 }

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
  const explorer = args.frame ? undefined : new Explorer(camera, canvas)
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
