import { Fn, positionView, varying } from 'three/tsl'
import type { Node } from 'three/webgpu'
import type { Vec3 } from '../../tsl-types'

/** A value of vertices as pixels see it: at a place inside of what they show. */
export function covered<T extends Node>(value: T): T {
  return varying(value).setInterpolation('perspective', 'centroid') as unknown as T
}

/** The varying that all who ask share: each of its own would be interpolated once more. */
let shared: Vec3 | null = null

/**
 * Position of a fragment in view space [world units], inside of what it shows.
 *
 * With multisampling `positionView` is that of the pixel's middle, which at silhouettes is not on the
 * surface: where the ground is seen edge-on, at the horizon, it lies far above the ground.
 */
export const coveredPosition = /*#__PURE__*/ Fn(({ material }): Vec3 => {
  // Without a vertex position there is only what the depth says.
  if ((material as { vertexNode?: object | null }).vertexNode) return positionView
  return (shared ??= covered(positionView as Vec3))
})
