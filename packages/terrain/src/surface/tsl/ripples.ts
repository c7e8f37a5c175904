import { vec3 } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'

/**
 * Ripples of sand along the axes [rad/m], in 2π/256 so that they are the same about every reference: 0.3 m long at the equator, 0.6 m at 60°. Without:
 * a beach is a brown plain (*Terrain*, still shore).
 */
const RIPPLES = /*#__PURE__*/ vec3(4.4179, 2.9452, 22.0893)

/** Height of ripples [m], what pixels take of it per side on the ground [–], and how far spots bend crests [rad]. */
const HEIGHT = 0.01
const FADE = 0.05
const BEND = 2

/**
 * Gradient of ripples of sand [–]; none where they are smaller than a pixel.
 *
 * @param offset - As of `latticeNoise`.
 * @param spots - Spots of metres, about 0.
 * @param footprint - Longer side of the pixel on the ground [m].
 */
export const ripples = (offset: Vec3, spots: Float, footprint: Float): Vec3 =>
  RIPPLES.mul(
    offset.dot(RIPPLES).add(spots.mul(BEND)).sin().mul(footprint.mul(-FADE).add(HEIGHT).max(0))
  )
