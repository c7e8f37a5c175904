import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import type { ViewpointScalars } from '../tsl/viewpoint'
import { homogeneousHeight } from '../../air/cpu/medium'

/** Growth of the slices along a ray over that of the scale height of molecules: larger puts more slices low. */
const STEP_GROWTH = 0.4

/** Viewpoints lower than this are lifted to it: on the ground itself the horizon has no distance [m]. */
export const LOWEST_VIEWPOINT = 1

function exponent(rise: number, height: number): number {
  const value = Math.min(Math.max((STEP_GROWTH * rise) / height, -4), 4)
  return Math.sign(value || 1) * Math.max(Math.abs(value), 0.05)
}

/**
 * Scalars that the sky volume is computed and read with.
 *
 * @param altitude - Altitude of the viewpoint in the mapped space [m].
 * @param cosLight - μ_s at the viewpoint.
 */
export function viewpointScalars(
  parameters: AtmosphereParameters,
  altitude: number,
  cosLight: number
): ViewpointScalars<number> {
  const { bottomRadius, topRadius } = parameters
  const thickness = topRadius - bottomRadius
  const h = Math.max(altitude, LOWEST_VIEWPOINT)
  // From afar, squares of distances cancel in shaders: all scalars are of the radius as float32 adds it up.
  const isFar = h > bottomRadius
  const radius = isFar ? Math.fround(bottomRadius + Math.fround(h)) : bottomRadius + h
  const height = isFar ? radius - bottomRadius : h
  const sinHorizon = bottomRadius / radius
  const dip = Math.acos(sinHorizon)
  const above =
    radius > topRadius ? Math.asin(topRadius / radius) - Math.asin(sinHorizon) : Math.PI / 2 + dip
  const start = Math.min(h, thickness)
  const scale = homogeneousHeight(parameters)
  const groundExponent = exponent(-start, scale)
  const skyExponent = exponent(thickness - start, scale)
  return {
    altitude: h,
    radius,
    toHorizon: height * (bottomRadius + radius),
    toTop: (thickness - height) * (topRadius + radius),
    cosLight,
    sinLight: Math.sqrt(Math.max(1 - cosLight ** 2, 0)),
    cosHorizon: -Math.sin(dip),
    sinHorizon,
    belowScale: 1 / Math.tan((Math.PI / 2 - dip) / 2),
    aboveScale: 1 / Math.tan(above / 2),
    groundStretch: 1 / groundExponent,
    groundGrowth: Math.expm1(groundExponent),
    skyStretch: 1 / skyExponent,
    skyGrowth: Math.expm1(skyExponent)
  }
}
