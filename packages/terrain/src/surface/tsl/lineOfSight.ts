import { float, positionViewDirection, smoothstep, transformNormalToView, vec2 } from 'three/tsl'
import type { Float, Vec2, Vec3 } from '../../tsl-types'

/** Footprints between which depth fades out [m], and least cosine to the viewer that it is found by. */
const FADES = { from: 0.006, to: 0.02 }
const GRAZING = 0.25

/** Steps by which a line of sight goes down until it meets the ground. Fewer: fringes at steep edges. */
const STEPS = 8

/** Line of sight over ground that has depth. */
export interface LineOfSight {
  /** Displacement along the frame, towards the viewer, per metre of rise [m]. */
  readonly slope: Vec2
  /** Share of depth that is left: none from some 5 m on. */
  readonly share: Float
}

/**
 * Line of sight at a pixel, for parallax mapping: what stands h above the ground is seen h · slope nearer to the viewer.
 *
 * At grazing angles depth is less than it should be.
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

/**
 * Height at which a line of sight meets the ground, in [0, 1]: it goes down from 1 in even steps, and between the last two the ground is taken as
 * a plane.
 *
 * @param heightAt - Height of the ground where the line of sight is at a height, both in [0, 1].
 * @see Tatarchuk 2006, "Dynamic parallax occlusion mapping with approximate soft shadows", §4
 */
export function heightMet(heightAt: (height: Float) => Float): Float {
  const met = float(-1).toVar()
  /** Height of the ground over the line of sight, at the step before. */
  const before = float(-1).toVar()
  for (let n = 0; n <= STEPS; n++) {
    const height = 1 - n / STEPS
    const over = heightAt(float(height)).sub(height).toConst() as Float
    const back = over.div(over.sub(before).max(1e-4)).clamp(0, 1).div(STEPS)
    const isFirst = met.lessThan(0).and(over.greaterThanEqual(0))
    met.assign(isFirst.select(back.add(height).min(1), met))
    before.assign(over)
  }
  return met.max(0).toConst()
}
