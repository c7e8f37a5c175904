import type { Float } from '../tsl-types'
import type { Eye } from './eye'
import { pointAlong, scattering, type Air } from './scattering'
import type { AirBetween, RayLimits } from './skyVolume'
import { enterAir } from './skyVolumeBake'

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
  return scattering(air, ray, length, end.altitude.sub(ray.altitude), steps)
}
