import { WebGLCoordinateSystem } from 'three'
import {
  cameraFar,
  cameraNear,
  cameraProjectionMatrix,
  select,
  vec4,
  viewZToLogarithmicDepth
} from 'three/tsl'
import type { NodeBuilder, Renderer } from 'three/webgpu'
import type { Float, Vec3 } from '../../tsl-types'

/** Depth of a point in view space as the renderer writes it, clamped to its range. */
export function fragmentDepth(positionView: Vec3, builder: NodeBuilder): Float {
  const renderer = builder.renderer as Renderer & {
    logarithmicDepthBuffer: boolean
    reversedDepthBuffer: boolean
  }
  const clip = cameraProjectionMatrix.mul(vec4(positionView, 1)).toConst()
  const normalized = clip.z.div(clip.w)
  const isSigned =
    renderer.coordinateSystem === WebGLCoordinateSystem && !renderer.reversedDepthBuffer
  const projected = isSigned ? normalized.mul(0.5).add(0.5) : normalized
  const depth = renderer.logarithmicDepthBuffer
    ? select(
        clip.w.equal(1),
        projected,
        viewZToLogarithmicDepth(positionView.z.min(cameraNear.negate()), cameraNear, cameraFar)
      )
    : projected
  return depth.clamp(0, 1)
}
