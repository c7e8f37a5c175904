import { smoothstep, vec2 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Table } from '../../tables/TableAtlas'
import { TRANSMITTANCE_SIZE } from '../../tables/tableSizes'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import { distanceToTop } from '../../air/tsl/boundary'

const [WIDTH, HEIGHT] = TRANSMITTANCE_SIZE

/** ρ, the distance to the horizon; at the top of the air H, that along the ground's horizon to the top [m]. */
function horizonDistance({ bottomRadius }: AtmosphereUniforms, altitude: Float): Float {
  return altitude.mul(bottomRadius.mul(2).add(altitude)).max(0).sqrt()
}

/** Cosine of the zenith angle of the horizon, ≤ 0. */
export function horizonCosine(uniforms: AtmosphereUniforms, altitude: Float): Float {
  return horizonDistance(uniforms, altitude).div(uniforms.bottomRadius.add(altitude)).negate()
}

/**
 * Texture coordinates of a ray to the top of the air. Texels crowd at the horizon.
 *
 * @param altitude - Ray origin above the ground, in [0, thickness] [m].
 * @param cosView - μ, not below the horizon.
 * @returns Texture coordinates of texel centres, in (0, 1)².
 * @see Bruneton 2017, §4 "Transmittance precomputation"
 */
export function transmittanceUV(
  uniforms: AtmosphereUniforms,
  altitude: Float,
  cosView: Float
): Vec2 {
  const { bottomRadius, thickness } = uniforms
  const chord = horizonDistance(uniforms, thickness).toConst()
  const horizon = horizonDistance(uniforms, altitude).toConst()
  const distance = distanceToTop(altitude, cosView, bottomRadius, thickness)
  const shortest = thickness.sub(altitude)
  const x = distance.sub(shortest).div(horizon.add(chord).sub(shortest).max(1))
  return vec2(x, horizon.div(chord))
    .clamp()
    .mul(vec2(WIDTH - 1, HEIGHT - 1))
    .add(0.5)
    .div(vec2(WIDTH, HEIGHT))
}

/**
 * The inverse of {@link transmittanceUV}.
 *
 * @param uv - Texture coordinates of texel centres.
 * @returns Altitude [m] and length of the ray [m].
 */
export function transmittanceRay(
  uniforms: AtmosphereUniforms,
  uv: Vec2
): { altitude: Float; cosView: Float; distance: Float } {
  const { bottomRadius, thickness } = uniforms
  const { x, y } = uv
    .mul(vec2(WIDTH, HEIGHT))
    .sub(0.5)
    .div(vec2(WIDTH - 1, HEIGHT - 1))
    .clamp()
    .toConst()
  const chord = horizonDistance(uniforms, thickness).toConst()
  const horizon = chord.mul(y).toConst()
  // ρ² = h (2 r_bottom + h), solved for h without cancellation.
  const square = horizon.mul(horizon).toConst()
  const radius = square.add(bottomRadius.mul(bottomRadius)).sqrt().toConst()
  const altitude = square.div(radius.add(bottomRadius)).toConst()
  const shortest = thickness.sub(altitude).toConst()
  const distance = shortest.add(x.mul(horizon.add(chord).sub(shortest))).toConst()
  const cosView = chord
    .mul(chord)
    .sub(square)
    .sub(distance.mul(distance))
    .div(radius.mul(distance).mul(2).max(1))
    .clamp(-1, 1)
  return {
    altitude: altitude,
    cosView: distance.lessThan(1).select(1, cosView),
    distance: distance
  }
}

/**
 * Part of the sun's light that arrives at a point: transmittance times the part of the disc that
 * stands above the horizon.
 *
 * @param table - Optical depth to the top of the air.
 * @param altitude - Above the ground, in [0, thickness] [m].
 * @param cosLight - μ_s, cosine of the light's zenith angle.
 * @returns Four values in [0, 1].
 * @see Bruneton 2017, "Single scattering"; smoothstep stands for the area of a cut disc
 */
export function lightTransmittance(
  uniforms: AtmosphereUniforms,
  table: Table,
  altitude: Float,
  cosLight: Float
): Vec4 {
  const { bottomRadius, sunAngularRadius } = uniforms
  const cosHorizon = horizonCosine(uniforms, altitude).toConst()
  const margin = bottomRadius.div(bottomRadius.add(altitude)).mul(sunAngularRadius).toConst()
  const visible = smoothstep(margin.negate(), margin, cosLight.sub(cosHorizon))
  const uv = transmittanceUV(uniforms, altitude, cosLight.max(cosHorizon))
  return table.sample(uv).negate().exp().mul(visible)
}
