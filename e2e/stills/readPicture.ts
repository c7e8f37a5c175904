import type { RenderTarget } from 'three'
import type { Renderer } from 'three/webgpu'

/** Picture of a target, RGBA, rows top-down. */
export async function readPicture(renderer: Renderer, target: RenderTarget): Promise<Uint8Array> {
  const { width, height } = target
  return (await renderer.readRenderTargetPixelsAsync(target, 0, 0, width, height)) as Uint8Array
}
