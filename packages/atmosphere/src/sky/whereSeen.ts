import { context } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Bool } from '../tsl-types'

/** Context of the nodes of a picture, by {@link whereSeen}. */
interface SeenContext {
  welkinIsSeen?: Bool
}

/**
 * A picture in pixels where it is seen: in others an `AerialPerspectiveNode` leaves air and sky out, and the colour means
 * nothing. For what draws something over the picture that hides it, as clouds do.
 *
 * @param picture - Colour of which each pixel is drawn for itself.
 * @param isSeen - True where it is; a value of the shader that reads the picture.
 */
export const whereSeen = (picture: Node, isSeen: Node): Node =>
  // Apart from the same picture elsewhere in the shader, which is drawn in full.
  context(picture, { welkinIsSeen: isSeen }).isolate()

/** True where the picture that is built is seen; null if it is everywhere. */
export const seenIn = (builder: NodeBuilder): Bool | null =>
  (builder as unknown as { context: SeenContext }).context.welkinIsSeen ?? null
