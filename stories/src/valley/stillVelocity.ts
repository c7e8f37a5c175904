import { Matrix4, type PerspectiveCamera } from 'three'
import { Fn, getViewPosition, uniform, uv, vec4 } from 'three/tsl'
import type { Node, TextureNode } from 'three/webgpu'

/**
 * Velocities of a picture of things that stand still, from depth and two frames' cameras: the scene's pass need not write them.
 * The sky counts as standing at the camera's far plane.
 *
 * @param depth - As the renderer writes it.
 * @returns Normalized device coordinates a frame, as three's `velocity` has them.
 */
export function stillVelocity(depth: TextureNode, camera: PerspectiveCamera): Node<'vec4'> {
  const previous = new Matrix4()
  const current = new Matrix4()
  let isFirst = true
  /** View space to the clip space of the last frame. */
  const toPrevious = uniform(new Matrix4()).onFrameUpdate((_frame, { value }) => {
    const { projectionMatrix, matrixWorldInverse, matrixWorld } = camera
    previous.copy(current)
    current.multiplyMatrices(projectionMatrix, matrixWorldInverse)
    if (isFirst) previous.copy(current)
    isFirst = false
    value.multiplyMatrices(previous, matrixWorld)
  })
  const unprojection = uniform(camera.projectionMatrixInverse)
  return Fn(() => {
    const at = uv()
    const { r } = depth as unknown as { r: Node<'float'> }
    const place = getViewPosition(at, r, unprojection)
    const before = (toPrevious as unknown as Node<'mat4'>).mul(vec4(place, 1)).toConst()
    const now = at.mul(2).sub(1)
    const ndc = before.xy.div(before.w.max(1e-6))
    return vec4(now.x.sub(ndc.x), now.y.negate().sub(ndc.y), 0, 1)
  })()
}
