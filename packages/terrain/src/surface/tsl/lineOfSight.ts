import { positionViewDirection, smoothstep, transformNormalToView, vec2 } from 'three/tsl'
import type { Float, Vec2, Vec3 } from '../../tsl-types'

/** Footprints between which depth fades out [m], and least cosine to the viewer that it is found by. */
const FADES = { from: 0.006, to: 0.02 }
const GRAZING = 0.25

/** Steps by which a line of sight finds the ground's depth. */
export const STEPS_OF_SIGHT = 3

/** Line of sight over ground that has depth. */
export interface LineOfSight {
  /** Way along the frame on which it rises by 1 m, towards the viewer [m]. */
  readonly slope: Vec2
  /** Share of depth that is left: none from some 5 m on. */
  readonly share: Float
}

/**
 * Line of sight at a pixel, for parallax mapping: what stands h above the ground is seen h · slope nearer to the viewer.
 *
 * A fixed point of that finds it in some steps, as long as the ground's own slopes are below the line's (Kaneko et al. 2001, "Detailed shape representation with
 * parallax mapping"; Premecz 2006, "Iterative parallax mapping with slope information"). At grazing angles depth is less than it should be.
 *
 * @param frame - Orthonormal vectors along the surface, like `normal` in the mesh's own axes.
 * @param footprint - Longer side of the pixel on the ground [m].
 */
export function lineOfSight(
  normal: Vec3,
  { tangent, bitangent }: { tangent: Vec3; bitangent: Vec3 },
  footprint: Float
): LineOfSight {
  const cosine = (vector: Vec3): Float =>
    (transformNormalToView(vector) as unknown as Vec3).dot(positionViewDirection)
  const slope = vec2(cosine(tangent), cosine(bitangent)).div(cosine(normal).max(GRAZING))
  return {
    slope: slope.toConst(),
    share: smoothstep(FADES.from, FADES.to, footprint).oneMinus().toConst()
  }
}
