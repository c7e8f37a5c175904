import { float } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Table } from '../../tables/TableAtlas'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import type { Float, Vec4 } from '../../tsl-types'
import { diffuseLightReader, diffuseMoments } from './diffuseLight'
import { applyMoments, momentBasis } from './moments'

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
  const facesUp = cosNormal.greaterThanEqual(0).toConst()
  const up = read(6).toConst()
  const down = read(7).toConst()
  const horizontal = facesUp.select(float(1), float(-1)).toConst() as Float
  const lobe = (cosine: Float, cosineLight: Float): Vec4 =>
    applyMoments(moments, momentBasis(cosine, cosLight, cosineLight), COSINE_1, COSINE_2).mul(
      Math.PI
    )
  const approximate = lobe(horizontal, horizontal.mul(cosLight))
  const missing = facesUp.select(up, down).sub(approximate)
  return lobe(cosNormal, cosNormalLight)
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
