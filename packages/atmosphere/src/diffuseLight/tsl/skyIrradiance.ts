import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Table } from '../../tables/TableAtlas'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import type { Float, Vec4 } from '../../tsl-types'
import { diffuseLightReader, diffuseMoments } from './diffuseLight'
import { applyMoments, momentBasis, SH1, SH20 } from './moments'

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
  const square = cosNormal.mul(cosNormal).toConst()
  const rest = square.oneMinus().toConst()
  // Of a horizontal plane only m00, m10 and m20 are left: the square of what they give it is taken away with their own.
  const basis = {
    ...momentBasis(cosNormal, cosLight, cosNormalLight),
    m10: cosNormal.mul(cosNormal.abs().oneMinus()).mul(SH1),
    m20: rest.mul(-SH20)
  }
  const m00 = moments.m00.mul(rest)
  return applyMoments({ ...moments, m00 }, basis, COSINE_1, COSINE_2)
    .mul(Math.PI)
    .add(read(cosNormal.lessThan(0).select(1, 0), 3).mul(square))
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
  return { up: read(0, 3).div(RADIANCE_SCALE), down: read(1, 3).div(RADIANCE_SCALE) }
}
