import { InterpolationSamplingMode, InterpolationSamplingType } from 'three'
import { Fn, positionView, varying } from 'three/tsl'
import type { Vec3 } from '../../tsl-types'

/**
 * Position of a fragment in view space [world units], inside of what it shows.
 *
 * With multisampling `positionView` is that of the pixel's middle, which at silhouettes is not on the
 * surface: where the ground is seen edge-on, at the horizon, it lies far above the ground.
 */
export const coveredPosition = /*#__PURE__*/ Fn(({ material }): Vec3 => {
  // Without a vertex position there is only what the depth says.
  if ((material as { vertexNode?: object | null }).vertexNode) return positionView
  const covered = varying(positionView)
  covered.setInterpolation(
    InterpolationSamplingType.PERSPECTIVE,
    InterpolationSamplingMode.CENTROID
  )
  return covered
})
