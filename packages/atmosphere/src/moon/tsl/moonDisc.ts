import { float, mix, smoothstep, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Float, Mat3, Vec2, Vec3, Vec4 } from '../../tsl-types'
import { BRIGHTEST_GROUND, MAP_RADIUS, moonMapUV } from './moonSurface'

/** Steepest slope that the map can hold. */
const RELIEF = 0.6

/** What a shader knows about the moon. Vectors are in the mapped space, of unit length. */
export interface MoonDisc {
  direction: Vec3
  /** From the moon to the sun. */
  light: Vec3
  /** The mapped space to moon-fixed axes. */
  toFixed: Mat3
  /** [rad] */
  angularRadius: Float
  /** Radiance of ground in sunlight, for a Lommel–Seeliger factor of 1 [1/sr]. */
  sunlit: Vec4
  /** Radiance of all the disc by light from the planet [1/sr]. */
  earthlit: Vec4
  map: TextureNode
}

/**
 * The moon's disc: how much of a pixel it covers, and its radiance.
 *
 * The ground scatters as Lommel and Seeliger say, μ₀/(μ₀ + μ): the full moon is flat, without the dark
 * limb of a Lambertian ball.
 *
 * @param direction - Of view, unit length.
 * @param pixel - Angle that a pixel covers [rad].
 * @see Hapke 2012, §8.6; Buratti, Hillier & Wang 1996, Icarus 124, 490
 */
export function moonDisc(
  moon: MoonDisc,
  direction: Vec3,
  pixel: Float
): { coverage: Float; radiance: Vec4 } {
  // The chord, not the cosine: near 1 that has a hundredth of the disc's radius for a step.
  const offset = direction.sub(moon.direction).div(moon.angularRadius).toConst()
  const part = offset.length().toConst()
  const edge = pixel.div(moon.angularRadius).mul(0.5).max(1e-4).toConst()
  const coverage = smoothstep(edge.negate(), edge, part.oneMinus())
  // Pixels at the edge take the ground just inside.
  const across = offset.div(part.max(1)).toConst()
  const height = across.dot(across).oneMinus().max(0).sqrt().toConst()
  const normal = across.sub(moon.direction.mul(height)).normalize().toConst() as Vec3
  const place = moon.toFixed.mul(normal).toConst() as Vec3
  const { width } = moon.map.value.image as { width: number }
  const level = pixel
    .div(moon.angularRadius)
    .mul(width / (2 * MAP_RADIUS))
    .max(1e-6)
    .log2()
  const sampled = moon.map as unknown as { sample(uv: Vec2): { level(n: Float): Vec4 } }
  const ground = sampled.sample(moonMapUV(place)).level(level.max(0)).toConst()
  // Row vector times matrix: the transposed, from moon-fixed axes back.
  const gradient = ground.xyz.mul(2).sub(1).mul(RELIEF).mul(moon.toFixed) as unknown as Vec3
  const bent = normal.sub(gradient).normalize().toConst()
  const cosView = bent.dot(moon.direction).negate().max(0).add(0.01)
  // Relief shades, but lights nothing that the sun is not up for; full, it does not show.
  const isDay = smoothstep(-0.04, 0.06, normal.dot(moon.light))
  const cosLight = bent.dot(moon.light).max(0).add(0.01).mul(isDay).toConst()
  const lit = cosLight.div(cosLight.add(cosView))
  const bright = ground.w.mul(BRIGHTEST_GROUND)
  const radiance = vec4(moon.sunlit.mul(lit).add(moon.earthlit).mul(bright))
  return { coverage: coverage, radiance }
}

/**
 * The sun's corona [1/sr], for unit irradiance of the sun.
 *
 * @param distance - From the middle of the sun, over its radius.
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
