import { cameraProjectionMatrixInverse, screenUV, select, vec2, vec3, vec4 } from 'three/tsl'
import type { Bool, Mat4, Vec3 } from '../../tsl-types'

/** A fragment's line of sight in view space. */
interface ScreenRay {
  /** Direction, not of unit length. */
  direction: Vec3
  /** Start: the viewpoint, or for an orthographic camera a point beside it. */
  origin: Vec3
  isOrthographic: Bool
}

/** The fragment's line of sight, for a perspective or orthographic camera. */
export function screenRay(): ScreenRay {
  const inverse = cameraProjectionMatrixInverse as unknown as Mat4
  const ndc = vec2(screenUV.x, screenUV.y.oneMinus()).mul(2).sub(1)
  // Depth cancels for a perspective camera: only the ratio of x, y to −z counts.
  const perspective = vec3(inverse.mul(vec4(ndc, 0.5, 1)).xyz).toConst()
  // Not the last element: a perspective camera's is 1 as well if its near plane is at 1.
  const isOrthographic = inverse.element(2).element(3).equal(0).toConst()
  const direction = perspective.mul(perspective.z.lessThan(0).select(1, -1))
  return {
    direction: select(isOrthographic, vec3(0, 0, -1), direction),
    origin: select(isOrthographic, vec3(perspective.xy, 0), vec3(0)),
    isOrthographic: isOrthographic
  }
}
