import type { Vector3 } from 'three'
import { fail } from '@welkin/geo'

/**
 * A point among clouds, and the light about it as it is without them: irradiances for unit irradiance of the
 * source on a plane across its rays, a value for each wavelength.
 */
export interface CloudedPoint {
  /** Position in world space. */
  readonly position: Vector3
  /** Altitude above the ground [m]. */
  readonly altitude: number
  /** μ_s. */
  readonly cosLight: number
  /** Irradiance of a level plane at an altitude [m] by the source itself. */
  direct: (altitude: number) => readonly number[]
  /** Irradiance of level planes at an altitude [m], facing up and down, by sky and ground. */
  diffuse: (altitude: number) => { up: readonly number[]; down: readonly number[] }
  /** Albedo of the ground at the four wavelengths, in [0, 1]. */
  readonly groundAlbedo: readonly number[]
}

/** Clouds as questions about light ask for them: `CloudCover` of `@welkin/clouds`, or one's own. */
export interface CloudedSky {
  /** Part of the source's light that passes the clouds above a point unscattered, in the mean over clouds and gaps; in [0, 1]. */
  beam(point: Omit<CloudedPoint, 'direct' | 'diffuse' | 'groundAlbedo'>): number
  /**
   * Irradiance of a plane by sky, clouds and ground, of what the clouds have scattered too.
   *
   * @param cosNormal - The plane's normal against the zenith.
   * @param clear - Irradiance by sky and ground without clouds.
   */
  irradiance(point: CloudedPoint, cosNormal: number, clear: readonly number[]): readonly number[]
}

/** @throws If they are neither clouds nor left out. */
export function checkCloudedSky(where: string, clouds: CloudedSky | null | undefined): void {
  const isGiven = clouds !== undefined && clouds !== null
  if (isGiven && !(typeof clouds.beam === 'function' && typeof clouds.irradiance === 'function')) {
    fail(where, 'clouds must be a CloudCover of @welkin/clouds, or null', clouds)
  }
}
