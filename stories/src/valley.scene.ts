import { cloudQualities } from '@welkin/clouds'
import type { CloudQualityName } from '@welkin/clouds'
import { Vector3 } from 'three'
import { Explorer } from './moving/Explorer'
import { EYE_HEIGHT } from './moving/Walk'
import { createRenderer, drawSettled, fitToCanvas, frameClock } from './scene'
import type { RendererArgs, SceneHandle } from './scene'
import { Readout } from './valley/readout'
import { Valley, type ValleyState } from './valley/Valley'

/** A view of the valley: position and target of the camera [m]. */
interface ValleyView {
  readonly label: string
  readonly position: readonly [number, number, number]
  readonly target: readonly [number, number, number]
}

export const VIEWS = {
  village: { label: 'Village', position: [300, 34, 520], target: [330, 80, -1500] },
  shore: { label: 'Shore', position: [120, 2.5, -330], target: [60, 150, -3000] },
  slope: { label: 'From a slope', position: [1150, 330, 900], target: [-300, 60, -2200] },
  above: { label: 'Above the clouds', position: [-900, 3100, 5200], target: [0, 1300, -4000] }
} satisfies Record<string, ValleyView>

export interface ValleyArgs extends RendererArgs, Omit<ValleyState, 'quality'> {
  view: keyof typeof VIEWS
  quality: CloudQualityName
}

/** A still marches every pixel of the clouds in every frame, coarsely. */
const STILL = { quality: { ...cloudQualities.low, block: 1 as const }, frames: 3 }

/** Time of the clouds' drift at the start, and in a still [s]. */
const STILL_TIME = 100

const stateOf = (args: ValleyArgs): ValleyState => ({
  ...args,
  paused: args.paused || args.frame,
  quality: args.frame ? STILL.quality : args.quality
})

/** A valley with all that Welkin has, at any hour and in any weather. */
export async function createValley(
  canvas: HTMLCanvasElement,
  args: ValleyArgs
): Promise<SceneHandle<ValleyArgs>> {
  const renderer = await createRenderer(canvas, args.forceWebGL, !args.frame)
  const current = { ...args }
  const valley = new Valley(renderer, stateOf(current))
  const { scene, camera } = valley
  const explorer = current.frame
    ? undefined
    : new Explorer(camera, canvas, { groundAt: place => valley.groundAt(place) })
  const readout = current.frame ? undefined : new Readout(canvas)
  await valley.bake(renderer)

  const goTo = (view: ValleyView, seconds: number): void => {
    const position = new Vector3(...view.position)
    position.y = Math.max(position.y, valley.groundAt(position) + EYE_HEIGHT)
    const direction = new Vector3(...view.target).sub(position).normalize()
    if (explorer !== undefined && seconds > 0) {
      void explorer.flyTo({ position, direction }, seconds)
      return
    }
    camera.position.copy(position)
    camera.lookAt(position.add(direction))
  }
  goTo(VIEWS[current.view], 0)

  const elapsed = frameClock(args.frame)
  let time = STILL_TIME
  const draw = (): void => {
    const start = performance.now()
    const delta = elapsed()
    explorer?.update(delta)
    valley.time = time += delta
    valley.render(delta)
    const spent = performance.now() - start
    const ground = valley.groundAt(camera.position)
    readout?.update(renderer, camera, ground, valley.cycle.hour, spent)
  }

  let ready: Promise<void> = Promise.resolve()
  const warmUp = (): void => {
    if (current.frame) ready = drawSettled(STILL.frames, draw, () => valley.exposure)
  }
  return {
    renderer,
    scene,
    camera,
    explorer,
    get ready() {
      return ready
    },
    progress: 1,
    render: draw,
    resize(width, height, pixelRatio) {
      fitToCanvas(renderer, camera, width, height, pixelRatio)
      warmUp()
    },
    update(changes) {
      const before = current.view
      Object.assign(current, changes)
      valley.set(stateOf(current), current.frame)
      if (current.view !== before) goTo(VIEWS[current.view], 4)
      warmUp()
    },
    dispose() {
      explorer?.dispose()
      readout?.dispose()
      valley.dispose()
      void renderer.dispose()
    }
  }
}
