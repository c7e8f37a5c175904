import type { Vector3 } from 'three'
import type { Float, Vec3, Vec4 } from '../tsl-types'

/** Height of the ground at a place, and its gradient: ECEF axes, any component along the normal is ignored. */
export interface HeightSample {
  /** Above the ellipsoid [m]. */
  height: number
  /** Metres per metre [–]. */
  readonly gradient: Vector3
}

/** A place of the ellipsoid's surface in a shader, exact to 1e-7 of the distance from the reference. */
export interface SurfacePoint {
  /** Point near the viewer in whole multiples of 256 m, ECEF axes, those of the world where that is flat [256 m]. */
  readonly reference: Vec3
  /** Place relative to the reference, ECEF axes [m]. */
  readonly offset: Vec3
}

/** Heights on the CPU, and bounds of them. */
export interface GroundBounds {
  /** Lower bound of all heights [m]. */
  readonly lowest: number
  /** Upper bound of all heights [m]. */
  readonly highest: number
  /** Counts up whenever heights have changed, such as those that were loaded; left out, they never do. */
  readonly version?: number
  /** Line that names the data's source. */
  readonly attribution?: string

  /**
   * Upper bound of the difference between the heights of two places.
   *
   * @param distance - Between them [m].
   * @returns [m]
   */
  variation(distance: number): number

  /**
   * Height and gradient on the CPU, with all detail.
   *
   * @param positionECEF - On the ellipsoid, or in a flat world on the plane y = 0, world axes [m].
   */
  sampleAt(positionECEF: Vector3, target: HeightSample): HeightSample
}

/**
 * Heights of a planet's ground, on the GPU and in float64 on the CPU. Both must agree: what is drawn is what one
 * walks on.
 */
export interface HeightSource extends GroundBounds {
  /** Seed of the patches of grass, rock and forest, a whole number ≥ 0, default 0. */
  readonly seed?: number

  /**
   * Height and gradient in a shader.
   *
   * @param point - On the ellipsoid.
   * @param shortest - Shortest wavelength of detail [m]: what is shorter is left out, twice that and more has its full strength.
   * @returns Gradient (xyz) [–] and height (w) [m].
   */
  sample(point: SurfacePoint, shortest: Float): Vec4
}
