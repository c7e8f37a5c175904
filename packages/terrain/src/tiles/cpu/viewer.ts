import { Frustum, Matrix4, Vector3 } from 'three'
import type { Camera, Plane } from 'three'
import { isFlat, type Figure } from './figure'

/** Viewer that tiles are chosen for. ECEF axes. */
export interface Viewer {
  /** Position of the viewer [m]. */
  readonly position: Vector3
  /**
   * Point from which distances to tiles count [m]: above the ellipsoid as high as the viewer is above the
   * ground, so that they are of the same kind on a mountain and at sea.
   */
  readonly datumPoint: Vector3
  /** Height above the ground [m]. */
  readonly clearance: number
  /** Sides of the view, relative to the position. */
  readonly planes: readonly Plane[]
  /** True of a viewer who looks from a point over the ground: one below it, or with parallel lines of sight, sees what ground hides from others. */
  readonly isOverGround: boolean
  /** Surface of the sea [m]; −Infinity for none. */
  readonly seaLevel: number
  /** Distance within which tiles out of view may cast shadows into it [m]; 0 for none. */
  readonly shadowDistance: number
  /** Unit vector to the viewer where the ellipsoid is the unit sphere. */
  readonly direction: Vector3
  /** Radius of the sphere that hides what is behind the horizon, where the ellipsoid is the unit sphere; at most 1. */
  readonly occluder: number
  /** Angle at the planet's centre from the viewer to the horizon; infinite in a flat world [rad]. */
  readonly horizon: number
  /** Its cosine; −1 in a flat world. */
  readonly cosHorizon: number
}

/** Angle at the centre of a sphere between a point and the horizon that one sees from it [rad]. */
export const horizonAngle = (radius: number, sphereRadius: number): number =>
  Math.acos(Math.min(sphereRadius / radius, 1))

const frustum = new Frustum()
const rotation = new Matrix4()
const subpoint = new Vector3()

/**
 * Viewer of a camera.
 *
 * @param positionECEF - Position of the camera [m].
 * @param clearance - Height above the ground [m], > 0.
 * @param lowest - Lower bound of all ground [m].
 * @param worldToECEF - Rotation and scale of the world, translation ignored.
 * @param shadowDistance - See {@link Viewer}, like `seaLevel` and `isOverGround`.
 */
export function viewerOf(
  camera: Camera,
  positionECEF: Vector3,
  clearance: number,
  lowest: number,
  worldToECEF: Matrix4,
  figure: Figure,
  shadowDistance: number,
  seaLevel = -Infinity,
  isOverGround = false
): Viewer {
  figure.footPoint(positionECEF, subpoint)
  const up = figure.surfaceNormal(positionECEF)
  // From ECEF axes at the camera to clip space.
  rotation.copy(worldToECEF).setPosition(0, 0, 0).invert()
  const view = camera.matrixWorldInverse.clone().setPosition(0, 0, 0).multiply(rotation)
  view.premultiply(camera.projectionMatrix)
  frustum.setFromProjectionMatrix(view, camera.coordinateSystem)
  const direction = positionECEF.clone().divide(figure.radii)
  const radius = direction.length()
  // Heights shrink by the largest radius at least, where the ellipsoid is the unit sphere.
  const occluder = 1 + Math.min(lowest, 0) / figure.minimumRadius
  const horizon = isFlat(figure) ? Infinity : horizonAngle(radius, occluder)
  return {
    position: positionECEF.clone(),
    datumPoint: subpoint.clone().addScaledVector(up, clearance),
    clearance,
    // Left, right, top and bottom: near and far depend on the kind of depth.
    planes: frustum.planes.slice(0, 4).map(plane => plane.clone()),
    isOverGround:
      isOverGround && !(camera as { isOrthographicCamera?: boolean }).isOrthographicCamera,
    seaLevel,
    shadowDistance,
    direction: direction.divideScalar(radius),
    occluder,
    horizon,
    cosHorizon: Math.cos(Math.min(horizon, Math.PI))
  }
}
