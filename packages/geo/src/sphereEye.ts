import { Vector3 } from 'three'
import { checkVector } from './check'
import type { Ellipsoid } from './Ellipsoid'

/** A position in the space where the ellipsoid is a sphere, split so that float32 can hold it. */
export interface SphereEye {
  /** Unit vector from the centre, in the mapped space. */
  up: Vector3
  /** Height above the mapped sphere [m]: within 0.34 % of the true one on the Earth. */
  height: number
}

/**
 * Scale by component that takes the ellipsoid to a sphere of radius a: a / radii. The `scale` of the
 * shader functions `ellipsoidToSphere` and `rayEllipsoid`.
 */
export function sphereScale(ellipsoid: Ellipsoid, target: Vector3 = new Vector3()): Vector3 {
  return ellipsoid.toSphere(target.set(1, 1, 1), target)
}

/**
 * The eye as the shader functions `rayEllipsoid` and `offsetHeight` take it: up and height in the
 * mapped space, subtracted here in float64, where centimetres survive.
 *
 * @param positionECEF - [m], not the centre.
 * @throws Error if a component is not finite.
 */
export function sphereEye(
  ellipsoid: Ellipsoid,
  positionECEF: Vector3,
  target: SphereEye = { up: new Vector3(), height: 0 }
): SphereEye {
  checkVector('sphereEye', 'positionECEF', positionECEF)
  ellipsoid.toSphere(positionECEF, target.up)
  target.height = target.up.length() - ellipsoid.a
  target.up.normalize()
  return target
}
