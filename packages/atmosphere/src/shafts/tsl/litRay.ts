import { densities } from '../../air/tsl/medium'
import { pointAlong, type Ray } from '../../scattering/tsl/ray'
import type { RayLimits } from '../../skyVolume/tsl/rayLimits'
import { EXTINCTION_SCALE, meanExtinction } from '../../skyVolume/tsl/meanExtinction'
import { viewRay } from '../../skyVolume/tsl/viewRay'
import { slicePosition } from '../../skyVolume/tsl/volumeMapping'
import type { Float, Vec4 } from '../../tsl-types'
import type { ViewUniforms } from '../../view/ViewUniforms'

/** Air at a distance on a view ray. */
export interface LitPoint extends ReturnType<typeof pointAlong> {
  /** Scattering coefficients of molecules and of aerosols, as the camera sees them: times the transmittance [1/m]. */
  readonly seenRayleigh: Vec4
  readonly seenMie: Vec4
}

/**
 * Reads the air along a view ray from the tables of its view.
 *
 * @param ray - View ray from its entry into the air.
 * @param denser - Factor on the density of the air, as it scatters light to the camera; null is 1.
 * @returns Air at a distance from there [m].
 */
export function litRay(
  { air, viewpoint, volume }: ViewUniforms,
  ray: Ray,
  limits: RayLimits,
  cosView: Float,
  denser: Float | null
): (inAir: Float) => LitPoint {
  const { uniforms } = air
  const elevation = viewRay(viewpoint, cosView, limits.hitsGround)
  return inAir => {
    const place = pointAlong(air, ray, inAir)
    const slice = slicePosition(viewpoint, limits, inAir)
    const extinction = meanExtinction(volume, viewpoint, elevation, slice)
    const depth = extinction.mul(inAir.div(EXTINCTION_SCALE))
    const through = depth
      .mul(denser ?? 1)
      .negate()
      .exp()
      .toConst()
    const density = densities(uniforms, place.altitude)
      .mul(denser ?? 1)
      .toConst()
    return {
      ...place,
      altitude: place.altitude.min(uniforms.thickness),
      seenRayleigh: uniforms.rayleighScattering.mul(density.x).mul(through),
      seenMie: uniforms.mieScattering.mul(density.y).mul(through)
    }
  }
}
