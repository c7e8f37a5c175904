import type { PerspectiveCamera, Scene } from 'three'
import type { WebGPURenderer } from 'three/webgpu'
import type { Explorer } from './moving/Explorer'
import { fitToCanvas, WARM_UP_FRAMES, type RendererArgs, type SceneHandle } from './scene'

/** A scene that needs nothing loaded once it is made. */
interface Drawn<Args extends RendererArgs> {
  readonly renderer: WebGPURenderer
  readonly scene: Scene
  readonly camera: PerspectiveCamera
  readonly explorer: Explorer | undefined
  /** Arguments that the scene shows: changes are assigned to it. */
  readonly current: Args
  /** Follows arguments that have changed. */
  readonly apply: (before: Readonly<Args>) => void
  /** Draws a frame. */
  readonly draw: () => void
  /** Draws the frames before one that counts; left out, `WARM_UP_FRAMES` of a still. */
  readonly warmUp?: () => Promise<void>
  /** Frees what the scene has made, but for its renderer and explorer. */
  readonly dispose: () => void
}

/** Handle of a scene, which is ready when its first frames are drawn. */
export function storyHandle<Args extends RendererArgs>({
  renderer,
  scene,
  camera,
  explorer,
  current,
  apply,
  draw,
  warmUp = async () => {
    for (let i = 0; current.frame && i < WARM_UP_FRAMES; i++) draw()
  },
  dispose
}: Drawn<Args>): SceneHandle<Args> {
  let ready = Promise.resolve()
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
      ready = warmUp()
    },
    update(changes) {
      const before = { ...current }
      Object.assign(current, changes)
      apply(before)
      ready = warmUp()
    },
    dispose() {
      explorer?.dispose()
      dispose()
      void renderer.dispose()
    }
  }
}
