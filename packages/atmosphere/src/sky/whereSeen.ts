import type { Material } from 'three'
import { context } from 'three/tsl'
import type { Node, NodeBuilder } from 'three/webgpu'
import type { Bool } from '../tsl-types'

/** Builder whose context is that of a picture by {@link whereSeen}, or not, and has the material that is built. */
type SeenBuilder = NodeBuilder & {
  context: { welkinSeen?: Bool; welkinBy?: Material; material: Material }
}

/**
 * A picture in pixels where it is seen: in others an `AerialPerspectiveNode` leaves air and sky out, and the colour means
 * nothing. For what draws something over the picture that hides it, as clouds do. What a pass of its own draws, such as three's
 * `convertToTexture`, is drawn in full.
 *
 * @param picture - Colour of which each pixel is drawn for itself.
 * @param isSeen - True where it is; a value of the shader that reads the picture.
 * @param builder - Builder of that shader.
 */
export const whereSeen = (picture: Node, isSeen: Node, builder: NodeBuilder): Node =>
  // Apart from the same picture elsewhere in the shader, which is drawn in full.
  context(picture, {
    welkinSeen: isSeen,
    welkinBy: (builder as SeenBuilder).context.material
  }).isolate()

/** True where the picture that is built is seen; null if it is everywhere. */
export const seenIn = (builder: NodeBuilder): Bool | null => {
  const { welkinSeen, welkinBy, material } = (builder as SeenBuilder).context
  // Three hands the context on to the shaders of textures that the picture is made of.
  return welkinBy === material ? welkinSeen! : null
}
