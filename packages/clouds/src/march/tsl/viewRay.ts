import {
  Fn,
  If,
  float,
  getViewPosition,
  isBackgroundDepth,
  logarithmicDepthToViewZ,
  vec3
} from 'three/tsl'
import type { Node, NodeBuilder, Renderer } from 'three/webgpu'
import type { CloudField } from '../../density/CloudField'
import type { FrameUniforms } from '../FrameUniforms'
import type { Bool, Float, LevelTexture, Mat3, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { FAR_AWAY, groundDistance } from './layerBoundaries'

/** Depth of a node at a place of the picture: a texture's, or that of the pixel that is drawn. */
export function depthAt(node: Node, at: Vec2): Float {
  const depth = node as unknown as LevelTexture<Vec2> & Vec4
  return typeof depth.sample === 'function' ? (depth.sample(at) as unknown as Vec4).r : depth.r
}

/** View ray through a pixel. */
export interface PixelRay {
  /** Normalized device coordinates of the pixel, and 1. */
  ndc: Vec3
  /** Length of `FrameUniforms.rays` times `ndc`, in the mapped space [m]. */
  length: Float
  /** Unit length, in the mapped space. */
  direction: Vec3
  /** Direction in view space, for each metre of the mapped space [world units/m]. */
  directionView: Vec3
}

/** Inputs from which view rays are made: the camera of a frame and the depth that it drew. */
export interface FrameInputs {
  readonly field: CloudField
  readonly frame: FrameUniforms
  /** Depth as the renderer writes it. */
  readonly depthAt: (uv: Vec2) => Float
}

/** View ray through a point of the image; to be called inside of a shader function. */
export function viewRayAt({ field, frame }: FrameInputs, uv: Vec2): PixelRay {
  const ndc = vec3(uv.x.mul(2).sub(1), uv.y.mul(-2).add(1), 1).toConst()
  const rayView = (frame.rays as unknown as Mat3).mul(ndc).toConst() as Vec3
  const mapped = field.view.toMapped(rayView).toConst() as Vec3
  const length = mapped.length().toConst() as Float
  const direction = mapped.div(length).toConst() as Vec3
  return { ndc, length, direction, directionView: rayView.div(length).toConst() }
}

/** z in view space where the scene was drawn, by its depth [world units]. */
const viewZAt = (frame: FrameUniforms, uv: Vec2, depth: Float): Float =>
  Fn((builder: NodeBuilder) => {
    const { logarithmicDepthBuffer: isLogarithmic } = builder.renderer as Renderer & {
      logarithmicDepthBuffer: boolean
    }
    return float(
      isLogarithmic
        ? logarithmicDepthToViewZ(depth, frame.near, frame.far)
        : getViewPosition(uv, depth, frame.projectionInverse).z
    )
  })()

/** True where something was drawn before a z in view space [world units]. To be called inside of a shader function. */
export function isDrawnBefore({ frame, depthAt }: FrameInputs, uv: Vec2, viewZ: Float): Bool {
  const depth = depthAt(uv).toConst() as Float
  return isBackgroundDepth(depth)
    .not()
    .and(viewZAt(frame, uv, depth).greaterThan(viewZ))
}

/**
 * Distance along a view ray to what was drawn, or to the ground; `FAR_AWAY` where there is neither [m]. To
 * be called inside of a shader function.
 *
 * @param missesGround - True where the ground is known not to be in sight.
 */
export function viewRayEnd(
  { field, frame, depthAt }: FrameInputs,
  uv: Vec2,
  { direction, directionView }: PixelRay,
  missesGround?: Bool
): Float {
  const depth = depthAt(uv).toConst() as Float
  const cosView = direction.dot(field.view.up).clamp(-1, 1).toConst() as Float
  const end = float(FAR_AWAY).toVar()
  const findGround = (): void => {
    end.assign(groundDistance(field, cosView))
  }
  if (missesGround === undefined) findGround()
  else If(missesGround.not(), findGround)
  If(isBackgroundDepth(depth).not(), () => {
    end.assign(end.min(viewZAt(frame, uv, depth).div(directionView.z)))
  })
  return end
}
