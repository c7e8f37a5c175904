import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import { sampleDiffuseLight, type DiffuseLightData } from './diffuseLight'
import { applyMoments } from './moments'

/** Legendre coefficients of the clamped cosine, A₀ … A₂ of ∫ L max(n·v, 0) dv = Σ A_l Σ M_lm Y_lm(n). */
export const COSINE_LOBE = [Math.PI, (2 * Math.PI) / 3, Math.PI / 4] as const

/**
 * Diffuse irradiance on a plane, for unit irradiance of the light source, one value per wavelength.
 *
 * The moments give it to degree 2; on horizontal planes, where the horizon's edge counts most, what
 * is missing is known exactly and blended in with the square of the normal's height.
 *
 * @param altitude - Altitude of the plane above the ground [m].
 * @param cosNormal - Plane's normal against the zenith.
 * @param cosLight - μ_s.
 * @param cosNormalLight - Plane's normal against the light.
 */
export function skyIrradiance(
  p: AtmosphereParameters,
  data: DiffuseLightData,
  altitude: number,
  cosNormal: number,
  cosLight: number,
  cosNormalLight: number
): number[] {
  const part = altitude / (p.topRadius - p.bottomRadius)
  const tiles = sampleDiffuseLight(data, part, cosLight)
  return [0, 1, 2, 3].map(i => {
    const moments = tiles.map(tile => tile[i])
    const isUp = cosNormal >= 0
    const horizontal = isUp ? 1 : -1
    const exact = moments[isUp ? 6 : 7]
    const approximate = applyMoments(
      moments,
      COSINE_LOBE,
      horizontal,
      cosLight,
      horizontal * cosLight
    )
    const here = applyMoments(moments, COSINE_LOBE, cosNormal, cosLight, cosNormalLight)
    return Math.max(here + cosNormal ** 2 * (exact - approximate), 0)
  })
}
