import { step } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Table } from '../../tables/TableAtlas'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import type { Float, Vec4 } from '../../tsl-types'
import { diffuseLightReader, diffuseMoments } from './diffuseLight'
import { applyMoments, momentBasis, SH0, SH1, SH20 } from './moments'

/** A₁/A₀ and A₂/A₀ of the clamped cosine. */
const COSINE_1 = 2 / 3
const COSINE_2 = 1 / 4

/**
 * Diffuse irradiance on a plane, for unit irradiance of the light source.
 *
 * The moments give it to degree 2; on horizontal planes, where the horizon's edge counts most, what
 * is missing is known exactly and blended in with the square of the normal's height.
 *
 * @param table - Diffuse-light table.
 * @param altitude - In [0, thickness] [m].
 * @param cosNormal - Plane's normal against the zenith.
 * @param cosLight - μ_s.
 * @param cosNormalLight - Plane's normal against the light.
 * @see Sloan 2008, "Stupid spherical harmonics tricks", "Irradiance environment maps". Twin: cpu/skyIrradiance.ts
 */
export function skyIrradiance(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosNormal: Float,
  cosLight: Float,
  cosNormalLight: Float
): Vec4 {
  const moments = diffuseMoments(uniforms, table, altitude, cosLight)
  const read = diffuseLightReader(uniforms, table, altitude, cosLight)
  const { m00, m10, m20 } = moments
  const facesDown = step(cosNormal, -1e-7).toConst() as Float
  const basis = momentBasis(cosNormal, cosLight, cosNormalLight)
  const lobe = applyMoments(moments, basis, COSINE_1, COSINE_2).mul(Math.PI)
  // The lobe about the vertical, whose other functions are 0.
  const approximate = m00
    .mul(Math.PI * SH0)
    .add(m10.mul(facesDown.mul(-2).add(1).mul(Math.PI * COSINE_1 * SH1)))
    .add(m20.mul(2 * Math.PI * COSINE_2 * SH20))
  const missing = read(6, facesDown).sub(approximate)
  return lobe
    .add(missing.mul(cosNormal.mul(cosNormal)))
    .max(0)
    .div(RADIANCE_SCALE)
}

/**
 * Diffuse irradiance on horizontal planes, for unit irradiance of the light source.
 *
 * @param table - Diffuse-light table.
 * @param altitude - In [0, thickness] [m].
 * @param cosLight - μ_s.
 * @returns On a plane that faces up, and on one that faces down.
 */
export function horizontalIrradiance(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosLight: Float
): { up: Vec4; down: Vec4 } {
  const read = diffuseLightReader(uniforms, table, altitude, cosLight)
  return { up: read(6).div(RADIANCE_SCALE), down: read(7).div(RADIANCE_SCALE) }
}
