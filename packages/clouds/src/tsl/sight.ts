import { If, float, getViewPosition, isBackgroundDepth, logarithmicDepthToViewZ } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { FrameUniforms } from '../FrameUniforms'
import type { Float, Mat4, Vec2, Vec3 } from '../tsl-types'
import { groundDistance } from './shells'

/** A line of sight through a pixel. */
export interface Sight {
  /** Unit length, in the mapped space. */
  direction: Vec3
  /** The same in view space, for each metre of the mapped space [world units/m]. */
  directionView: Vec3
  /** Distance to what was drawn, or to the ground; `FAR_AWAY` where there is neither [m]. */
  end: Float
}

/** How a camera's pixels are turned to lines of sight. */
export interface SightNodes {
  readonly field: CloudField
  readonly frame: FrameUniforms
  /** Depth as the renderer writes it. */
  readonly depthAt: (uv: Vec2) => Float
  readonly isLogarithmic: boolean
}

/** The line of sight of a place in the picture; to be called inside of a shader function. */
export function sightAt({ field, frame, depthAt, isLogarithmic }: SightNodes, uv: Vec2): Sight {
  const { view } = field
  const inverse = frame.projectionInverse as unknown as Mat4
  const depth = depthAt(uv).toConst() as Float
  // Any depth that is neither near nor far gives the direction.
  const middle = getViewPosition(uv, float(0.5), inverse).toConst() as Vec3
  const mapped = view.toMapped(middle).toConst() as Vec3
  const length = mapped.length().toConst() as Float
  const direction = mapped.div(length).toConst() as Vec3
  const end = groundDistance(field, direction.dot(view.up).clamp(-1, 1).toConst()).toVar()
  If(isBackgroundDepth(depth).not(), () => {
    const at = isLogarithmic
      ? middle.mul(logarithmicDepthToViewZ(depth, frame.near, frame.far).div(middle.z))
      : getViewPosition(uv, depth, inverse)
    end.assign(end.min(view.toMapped(at).length()))
  })
  return {
    direction,
    directionView: middle.div(length).toConst(),
    end
  }
}
