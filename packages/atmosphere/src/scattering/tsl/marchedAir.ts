import { If } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'
import type { Viewpoint } from '../../view/tsl/viewpoint'
import { groundRadiance, scatteredRadiance, scattering } from './scattering'
import { pointAlong, type Air } from './ray'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'
import type { RayLimits } from '../../skyVolume/tsl/rayLimits'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'

/**
 * Air between a viewpoint and a point by marching the ray, where `sampleVolume` reads the sky volume.
 *
 * @param cosView - μ, ray against the zenith of the viewpoint.
 * @param cosViewLight - ν, ray against the light.
 * @param limits - Limits of the same ray.
 * @param distance - Distance from the viewpoint; null for the whole ray [m].
 * @param steps - Number of steps of the march.
 */
export function marchedAir(
  air: Air,
  viewpoint: Viewpoint,
  cosView: Float,
  cosViewLight: Float,
  limits: RayLimits,
  distance: Float | null,
  steps: number
): MediumSegment {
  const { altitude, cosLight } = viewpoint
  const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
  const inside = distance === null ? limits.length : distance.sub(limits.start).max(0)
  const length = inside.min(limits.length).toConst() as Float
  const end = pointAlong(air, ray, length)
  const light = scattering(air, ray, length, end.altitude.sub(ray.altitude), steps)
  return { radiance: scatteredRadiance(air.uniforms, light, cosViewLight), depth: light.depth }
}

/**
 * Radiance of all the air along a ray and of the ground behind it by marching, where `sampleSky` reads
 * the sky volume, for unit irradiance of the light source [1/sr].
 *
 * @param limits - Limits of the same ray.
 * @param steps - Number of steps of the march.
 */
export function marchedSky(
  air: Air,
  viewpoint: Viewpoint,
  cosView: Float,
  cosViewLight: Float,
  limits: RayLimits,
  steps: number
): Vec4 {
  const between = marchedAir(air, viewpoint, cosView, cosViewLight, limits, null, steps)
  const radiance = between.radiance.toVar()
  If(limits.hitsGround, () => {
    const ray = {
      altitude: viewpoint.altitude,
      cosView,
      cosLight: viewpoint.cosLight,
      cosViewLight
    }
    const ground = pointAlong(air, ray, limits.start.add(limits.length))
    radiance.addAssign(groundRadiance(air, ground.cosLight).mul(between.depth.negate().exp()))
  })
  return radiance
}
