import { renderOutput, rtt } from 'three/tsl'
import type { Node, RenderPipeline } from 'three/webgpu'
import { smoothEdges } from '../../stories/src/valley/SmoothEdgesNode'

/**
 * Has a pipeline show an exposed picture as the story *Valley, all day* does: tone mapping, the display's colours, smooth edges.
 *
 * @returns The picture before, to be freed.
 */
export function finish(pipeline: RenderPipeline, picture: Node): { dispose(): void } {
  const shown = rtt(renderOutput(picture), null, null, { depthBuffer: false })
  pipeline.outputColorTransform = false
  pipeline.outputNode = smoothEdges(shown)
  pipeline.needsUpdate = true
  return shown
}
