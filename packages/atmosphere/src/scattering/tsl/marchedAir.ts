import { If } from 'three/tsl'
import type { Float, Vec4 } from '../../tsl-types'
import type { Eye } from '../../view/tsl/eye'
import { groundRadiance, pointAlong, scatteredRadiance, scattering, type Air } from './scattering'
import type { AirBetween, RayLimits } from '../../skyVolume/tsl/skyVolume'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'

/**
 * Air between an eye and a point by marching the ray, where `sampleVolume` reads the sky volume.
 *
 * @param cosView - μ, ray against the zenith of the eye.
 * @param cosViewSun - ν, ray against sun.
 * @param limits - Of the same ray.
 * @param distance - From the eye; null for the whole ray [m].
 * @param steps - Of the march.
 */
export function marchedAir(
  air: Air,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  limits: RayLimits,
  distance: Float | null,
  steps: number
): AirBetween {
  const { altitude, cosSun } = eye
  const ray = enterAir(air, { altitude, cosView, cosSun, cosViewSun }, limits)
  const inside = distance === null ? limits.length : distance.sub(limits.start).max(0)
  const length = inside.min(limits.length).toConst() as Float
  const end = pointAlong(air, ray, length)
  const light = scattering(air, ray, length, end.altitude.sub(ray.altitude), steps)
  return { radiance: scatteredRadiance(air.uniforms, light, cosViewSun), depth: light.depth }
}

/**
 * Radiance of all the air along a ray and of the ground behind it by marching, where `sampleSky` reads
 * the sky volume, for unit irradiance of the sun [1/sr].
 *
 * @param limits - Of the same ray.
 * @param steps - Of the march.
 */
export function marchedSky(
  air: Air,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  limits: RayLimits,
  steps: number
): Vec4 {
  const between = marchedAir(air, eye, cosView, cosViewSun, limits, null, steps)
  const radiance = between.radiance.toVar()
  If(limits.hitsGround, () => {
    const ray = { altitude: eye.altitude, cosView, cosSun: eye.cosSun, cosViewSun }
    const ground = pointAlong(air, ray, limits.start.add(limits.length))
    radiance.addAssign(groundRadiance(air, ground.cosSun).mul(between.depth.negate().exp()))
  })
  return radiance
}
