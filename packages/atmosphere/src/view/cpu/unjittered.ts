import { Matrix4 } from 'three'
import type { Camera, PerspectiveCamera } from 'three'

/**
 * Projection of a camera without the shift within a pixel that temporal anti-aliasing gives it (`traa` of three): what keeps
 * a history of its own takes that for a turn. A view offset of a whole pixel or more, or of a part of the picture, stays.
 *
 * @param target - Matrix that is set.
 * @returns The target.
 */
export function unjitteredProjection(camera: Camera, target: Matrix4 = new Matrix4()): Matrix4 {
  target.copy(camera.projectionMatrix)
  const { view, isPerspectiveCamera } = camera as PerspectiveCamera
  if (!isPerspectiveCamera || view?.enabled !== true) return target
  const { fullWidth, fullHeight, offsetX, offsetY, width, height } = view
  const isJitter = Math.abs(offsetX) < 1 && Math.abs(offsetY) < 1
  if (!isJitter || width !== fullWidth || height !== fullHeight) return target
  target.elements[8] -= (2 * offsetX) / fullWidth
  target.elements[9] += (2 * offsetY) / fullHeight
  return target
}
