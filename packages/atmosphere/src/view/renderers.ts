import type { Object3D, Scene } from 'three'
import type { Renderer } from 'three/webgpu'
import { fail } from '@welkin/geo'

/** @throws If it cannot draw nodes, as three's `WebGLRenderer` can't. */
export function checkRenderer(where: string, renderer: Renderer): void {
  if (renderer?.isRenderer) return
  const rule =
    "renderer must be a WebGPURenderer, from 'three/webgpu', which uses WebGL2 where there is no WebGPU"
  fail(where, rule, renderer)
}

/**
 * For what keeps textures that one renderer draws.
 *
 * @param owner - The renderer that drew them, or null.
 * @throws If it is no WebGPURenderer, or the owner is another one that was not disposed of.
 */
export function checkOwner(where: string, owner: Renderer | null, renderer: Renderer): void {
  if (owner === renderer) return
  checkRenderer(where, renderer)
  // Disposed renderers have no textures, and those in use have at least these.
  if (owner === null || owner.info.memory.textures === 0) return
  const rule = `renderer must be the first: one ${where} serves one renderer at a time, until either is disposed of`
  fail(where, rule, renderer)
}

type OnBeforeRender = (this: Scene, renderer: unknown, ...rest: unknown[]) => void
type Hooked = Scene & { onBeforeRender: OnBeforeRender }

const _watched = new WeakSet<Object3D>()

/**
 * Has the scene that a light is in throw when a renderer without nodes draws it. That one would light it
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
