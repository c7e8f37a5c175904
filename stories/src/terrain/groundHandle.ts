import type { Terrain } from '@welkin/terrain'
import type { PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import type { Air } from '../air'
import type { RendererArgs, SceneHandle } from '../scene'
import { storyHandle } from '../storyHandle'
import type { GroundCamera } from './GroundCamera'
import type { GroundFinish } from './GroundFinish'
import type { GroundView } from './viewAlong'

/** A scene on a terrain, with views to choose from. */
interface GroundScene<Args extends RendererArgs, Views extends Record<string, GroundView>> {
  readonly renderer: WebGPURenderer
  readonly scene: Scene
  readonly camera: PerspectiveCamera
  readonly current: Args & { view: keyof Views }
  readonly air: Air
  readonly terrain: Terrain
  readonly ground: GroundCamera
  readonly views: Views
  /** Follows arguments that have changed, but for the view. */
  readonly apply: () => void
  /** Frames to draw before a still, ahead of those that all have. */
  readonly load?: () => Promise<void>
  /** Moves on what follows the camera, ahead of each frame. */
  readonly follow?: () => void
  /** Post effects, if there are any. */
  readonly finish?: GroundFinish | undefined
  /** Frees what else the scene has made. */
  readonly dispose?: () => void
}

/** Handle of a scene on a terrain: it starts at its view, and flies to the one that is chosen. */
export function groundHandle<Args extends RendererArgs, Views extends Record<string, GroundView>>({
  renderer,
  scene,
  camera,
  current,
  air,
  terrain,
  ground,
  views,
  apply,
  load,
  follow,
  finish,
  dispose
}: GroundScene<Args, Views>): SceneHandle<Args & { view: keyof Views }> {
  apply()
  ground.goTo(views[current.view])
  const draw = (): void => {
    ground.update(air.sun)
    follow?.()
    if (finish) finish.draw(() => air.render())
    else air.render()
  }
  return storyHandle<Args & { view: keyof Views }>({
    renderer,
    scene,
    camera,
    explorer: ground.explorer,
    current,
    apply(before) {
      apply()
      if (current.view !== before.view) ground.goTo(views[current.view])
    },
    draw,
    async warmUp() {
      await load?.()
      await ground.warmUp(renderer, draw)
    },
    dispose() {
      terrain.dispose()
      dispose?.()
      air.dispose()
    }
  })
}
