import { fxaa } from 'three/addons/tsl/display/FXAANode.js'
import { renderOutput, rtt } from 'three/tsl'
import type { Node, RenderPipeline } from 'three/webgpu'

/**
 * Has a pipeline show an exposed picture as an app does at the end: tone mapping, the display's colours, FXAA.
 *
 * @returns What it draws with, to be freed.
 */
export function smoothEdges(pipeline: RenderPipeline, picture: Node): { dispose(): void } {
  const shown = rtt(renderOutput(picture), null, null, { depthBuffer: false })
  pipeline.outputColorTransform = false
  pipeline.outputNode = fxaa(shown)
  pipeline.needsUpdate = true
  return shown
}
