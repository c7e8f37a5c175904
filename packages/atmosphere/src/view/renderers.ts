import { Vector2, type Object3D, type Scene } from 'three'
import type { Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'

/** @throws If it cannot draw nodes, as three's `WebGLRenderer` can't. */
export function checkRenderer(where: string, renderer: Renderer): void {
  if (renderer?.isRenderer) return
  fail(where, 'renderer must be a WebGPURenderer of three/webgpu, for WebGL2 too', renderer)
}

const _size = new Vector2()

/** Size of the target that is drawn into, at least 1 × 1 [pixels]. */
export function drawnSize(renderer: Renderer): { width: number; height: number } {
  const { width, height } = renderer.getRenderTarget() ?? renderer.getDrawingBufferSize(_size)
  return { width: Math.max(width, 1), height: Math.max(height, 1) }
}

/**
 * Checks that a renderer is the one that drew an object's textures.
 *
 * @param owner - The renderer that drew them, or null.
 * @throws If it is no WebGPURenderer, or the owner is another one that was not disposed of.
 */
export function checkOwner(where: string, owner: Renderer | null, renderer: Renderer): void {
  if (owner === renderer) return
  checkRenderer(where, renderer)
  // Disposed renderers have no textures, and those in use have at least these.
  if (owner === null || owner.info.memory.textures === 0) return
  fail(where, 'renderer must be the first, until either is disposed of', renderer)
}

type OnBeforeRender = (this: Scene, renderer: unknown, ...rest: unknown[]) => void
type Hooked = Scene & { onBeforeRender: OnBeforeRender }

const _watched = new WeakSet<Object3D>()

/**
 * Watches the scene that a light is in: it throws when a renderer without nodes draws it. That one would light it
 * white under a black sky, and calls nothing else of ours. The first right renderer ends the watch.
 */
export function watchScene(where: string, light: Object3D): void {
  let root: Object3D = light
  while (root.parent !== null) root = root.parent
  if (_watched.has(root) || !('isScene' in root)) return
  _watched.add(root)
  const scene = root as Hooked
  const before = scene.onBeforeRender
  const watch: OnBeforeRender = function (renderer, ...rest) {
    checkRenderer(where, renderer as Renderer)
    if (scene.onBeforeRender === watch) scene.onBeforeRender = before
    before.call(this, renderer, ...rest)
  }
  scene.onBeforeRender = watch
}
