import { vec4 } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'
import { orenNayar, skyReflectance, sunGlint, type GroundAngles } from './groundReflection'

/** Light that comes back out of the sea by absorbing and scattering water, over the light on it. */
const WATER_REFLECTANCE = [0.05, 0.03, 0.018, 0.006] as const

/** Fraction of diffuse light that the sea's surface reflects in all directions. */
const SURFACE_REFLECTANCE = 0.045

/** Mean reflectance of the sea. */
export const seaAlbedo = (): Vec4 => vec4(...WATER_REFLECTANCE).add(SURFACE_REFLECTANCE)

/** Sun and sky on the ground, over `solarIrradiance`. */
export interface GroundIllumination {
  /** Irradiance of a plane that faces the sun. */
  sun: Vec4
  /** Irradiance of level ground by the sky. */
  sky: Vec4
}

/**
 * Radiance of land in sun and sky, a rough diffuse surface [1/sr].
 *
 * @param albedo - At the four wavelengths.
 * @param roughness - Standard deviation of its slopes [rad].
 */
export function landRadiance(
  { sun, sky }: GroundIllumination,
  angles: GroundAngles,
  albedo: Vec4,
  roughness: Float
): Vec4 {
  const direct = sun.mul(angles.cosLight.max(0)).mul(orenNayar(angles, roughness))
  return direct.add(sky).mul(albedo).div(Math.PI)
}

/**
 * Radiance of the sea in sun and sky: light from the water, the mirrored sky and the sun's glint [1/sr].
 *
 * @param variance - `seaSlopeVariance`.
 */
export function seaRadiance(
  { sun, sky }: GroundIllumination,
  angles: GroundAngles,
  variance: Float
): Vec4 {
  const fromWater = sun
    .mul(angles.cosLight.max(0))
    .add(sky)
    .mul(vec4(...WATER_REFLECTANCE))
  const mirroredSky = sky.mul(skyReflectance(angles.cosViewer, variance))
  const glint = sun.mul(sunGlint(angles, variance))
  return fromWater.add(mirroredSky).div(Math.PI).add(glint)
}
