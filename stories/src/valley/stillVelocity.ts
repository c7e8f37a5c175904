import { unjitteredProjection } from '@welkin/atmosphere'
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
  const projection = new Matrix4()
  let isFirst = true
  /** View space to the clip space of the last frame. */
  const toPrevious = uniform(new Matrix4()).onFrameUpdate((_frame, { value }) => {
    const { matrixWorldInverse, matrixWorld } = camera
    previous.copy(current)
    current.multiplyMatrices(unjitteredProjection(camera, projection), matrixWorldInverse)
    if (isFirst) previous.copy(current)
    isFirst = false
    value.multiplyMatrices(previous, matrixWorld)
  })
  const unprojection = uniform(camera.projectionMatrixInverse)
  const toScreen = uniform(projection)
  return Fn(() => {
    const { r } = depth as unknown as { r: Node<'float'> }
    const place = vec4(getViewPosition(uv(), r, unprojection), 1).toConst()
    const ndcBy = (matrix: Node): Node<'vec2'> => {
      const clip = (matrix as Node<'mat4'>).mul(place).toConst()
      return clip.xy.div(clip.w.max(1e-6))
    }
    return vec4(ndcBy(toScreen).sub(ndcBy(toPrevious)), 0, 1)
  })()
}
