import { float, mix, smoothstep, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Float, Mat3, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { MAX_GROUND_BRIGHTNESS, MAP_RADIUS, moonMapUV } from './moonSurface'

/** Largest slope that the map can hold. */
const MAX_SLOPE = 0.6

/** The moon's disc as shader nodes. Directions are in the mapped space, of unit length. */
export interface MoonDisc {
  /** Camera to moon. */
  directionMapped: Vec3
  /** Moon to sun. */
  sunDirectionMapped: Vec3
  /** Mapped space to moon-fixed axes. */
  mappedToMoonFixed: Mat3
  /** Angular radius of the disc [rad]. */
  angularRadius: Float
  /** Radiance of sunlit ground, for a Lommel–Seeliger factor of 1 [1/sr]. */
  sunlit: Vec4
  /** Radiance of the disc in earthshine [1/sr]. */
  earthlit: Vec4
}

/**
 * Radiance of the moon's disc, and the fraction of a pixel that it covers.
 *
 * The ground reflects by the Lommel–Seeliger law, μ₀/(μ₀ + μ): the full moon is flat, without the dark
 * limb of a Lambertian ball.
 *
 * @param map - `moonGround` by {@link moonMapUV}.
 * @param direction - View direction, mapped space, unit length.
 * @param pixel - Angle that a pixel covers [rad].
 * @see Hapke 2012, §8.6
 */
export function moonDisc(
  moon: MoonDisc,
  map: TextureNode,
  direction: Vec3,
  pixel: Float
): { coverage: Float; radiance: Vec4 } {
  // The chord, not the cosine: near 1 that has a hundredth of the disc's radius for a step.
  const offset = direction.sub(moon.directionMapped).div(moon.angularRadius).toConst()
  const fraction = offset.length().toConst()
  const edge = pixel.div(moon.angularRadius).mul(0.5).max(1e-4).toConst()
  const coverage = smoothstep(edge.negate(), edge, fraction.oneMinus())
  // Pixels at the edge take the ground just inside.
  const onDisc = offset.div(fraction.max(1)).toConst()
  const height = onDisc.dot(onDisc).oneMinus().max(0).sqrt().toConst()
  const normal = onDisc.sub(moon.directionMapped.mul(height)).normalize().toConst() as Vec3
  const groundDirection = moon.mappedToMoonFixed.mul(normal).toConst() as Vec3
  const { width } = map.value.image as { width: number }
  const level = pixel
    .div(moon.angularRadius)
    .mul(width / (2 * MAP_RADIUS))
    .max(1e-6)
    .log2()
  const sampled = map as unknown as { sample(uv: Vec2): { level(n: Float): Vec4 } }
  const ground = sampled.sample(moonMapUV(groundDirection)).level(level.max(0)).toConst()
  // Row vector times matrix multiplies by the transposed: moon-fixed axes back to the mapped space.
  const gradient = ground.xyz
    .mul(2)
    .sub(1)
    .mul(MAX_SLOPE)
    .mul(moon.mappedToMoonFixed) as unknown as Vec3
  const slopedNormal = normal.sub(gradient).normalize().toConst()
  const cosView = slopedNormal.dot(moon.directionMapped).negate().max(0).add(0.01)
  // Slopes shade the day side, and light nothing where the sun is below the moon's horizon.
  const isDay = smoothstep(-0.04, 0.06, normal.dot(moon.sunDirectionMapped))
  const cosLight = slopedNormal.dot(moon.sunDirectionMapped).max(0).add(0.01).mul(isDay).toConst()
  const lit = cosLight.div(cosLight.add(cosView))
  const albedo = ground.w.mul(MAX_GROUND_BRIGHTNESS)
  const radiance = vec4(moon.sunlit.mul(lit).add(moon.earthlit).mul(albedo))
  return { coverage, radiance }
}

/**
 * Radiance of the sun's corona, for unit irradiance of the sun [1/sr].
 *
 * @param distance - Distance from the middle of the sun, over its radius.
 * @see Baumbach 1937, AN 263, 121
 */
export function corona(uniforms: AtmosphereUniforms, distance: Float): Vec4 {
  const { sunAngularRadius, limbDarkening } = uniforms
  const r = distance.max(1).toConst()
  const profile = r.pow(-2.5).mul(0.0532).add(r.pow(-7).mul(1.425)).add(r.pow(-17).mul(2.565))
  const centre = limbDarkening.div(3).oneMinus().mul(sunAngularRadius).mul(sunAngularRadius)
  const outside = mix(float(0), float(1), smoothstep(0.99, 1.01, distance))
  return vec4(profile.mul(outside).mul(1e-6 / Math.PI)).div(centre)
}
