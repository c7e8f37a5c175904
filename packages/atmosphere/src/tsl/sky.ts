import { If, smoothstep, vec3, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import type { ViewNodes } from '../ViewNodes'
import { linearSRGB } from './color'
import type { Eye } from './eye'
import { groundRadiance, pointAlong, scatteredRadiance, type Air } from './scattering'
import {
  rayLimits,
  sampleVolume,
  type AirBetween,
  type RayLimits,
  type VolumeTextures
} from './skyVolume'

/** What is seen in a direction when nothing is in the way. */
export interface Sky {
  /** Light of sky and ground without the sun's disc, for unit irradiance of the sun [1/sr]. */
  radiance: Vec4
  /** Of the air in that direction. */
  transmittance: Vec4
  limits: RayLimits
}

/**
 * Sky, or the model's Lambertian ground, in a direction, from the sky volume.
 *
 * @param cosView - μ, direction against the zenith of the eye.
 * @param cosViewSun - ν, direction against the sun.
 */
export function skyInDirection(
  air: Air,
  volume: VolumeTextures,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float
): Sky {
  const limits = rayLimits(air.uniforms, eye, cosView)
  const between = sampleVolume(air.uniforms, volume, eye, cosView, cosViewSun, limits, null)
  return skyBehind(air, eye, cosView, cosViewSun, limits, between)
}

/**
 * Light of all the air along a ray, and of the ground where the ray meets it.
 *
 * @param between - Air from the eye to the end of the ray, however it was found.
 */
export function skyBehind(
  air: Air,
  eye: Eye,
  cosView: Float,
  cosViewSun: Float,
  limits: RayLimits,
  between: AirBetween
): Sky {
  const transmittance = between.depth.negate().exp().toConst() as Vec4
  const radiance = scatteredRadiance(air.uniforms, between, cosViewSun).toVar()
  If(limits.hitsGround, () => {
    const ray = { altitude: eye.altitude, cosView, cosSun: eye.cosSun, cosViewSun }
    const ground = pointAlong(air, ray, limits.start.add(limits.length))
    radiance.addAssign(groundRadiance(air, ground.cosSun).mul(transmittance))
  })
  return { radiance: radiance, transmittance, limits }
}

/**
 * Radiance of the sun's disc above the air, for unit irradiance [1/sr].
 *
 * The limb darkens as I(ρ) ∝ 1 − u (1 − √(1 − ρ²)), normalised so that the disc gives the irradiance.
 *
 * @param direction - Of view, unit length.
 * @param sunDirection - Unit length, same frame.
 * @param pixel - Angle that a pixel covers, over which the edge is smoothed [rad].
 */
export function sunDisc(
  uniforms: AtmosphereUniforms,
  direction: Vec3,
  sunDirection: Vec3,
  pixel: Float
): Vec4 {
  const { sunAngularRadius, limbDarkening } = uniforms
  // The chord, not the cosine: near 1 that has a hundredth of the disc's radius for a step.
  const part = direction.sub(sunDirection).length().div(sunAngularRadius).toConst()
  const edge = pixel.div(sunAngularRadius).mul(0.5).max(1e-4)
  const coverage = smoothstep(edge.negate(), edge, part.oneMinus())
  const cosLimb = part.mul(part).oneMinus().max(0).sqrt()
  const profile = limbDarkening
    .mul(cosLimb.oneMinus())
    .oneMinus()
    .div(limbDarkening.div(3).oneMinus())
  const solidAngle = sunAngularRadius.mul(sunAngularRadius).mul(Math.PI)
  return vec4(profile.mul(coverage).div(solidAngle))
}

/** Brightest output: half-float targets hold up to 65504, and the sun's disc is brighter. */
const BRIGHTEST = 60_000

/** Angle between a fragment's line of sight and the next one's [rad]. Not for use in branches. */
export function pixelAngle(rayView: Vec3): Float {
  return rayView.normalize().fwidth().length().toConst()
}

/**
 * Sky, ground and sun in a direction of view.
 *
 * @param rayView - Direction in view space, any length.
 * @param pixel - {@link pixelAngle} of it; null to leave the sun's disc out.
 * @returns Linear sRGB × `luminanceScale`.
 */
export function skyColor(view: ViewNodes, rayView: Vec3, pixel: Float | null): Vec3 {
  const { air, volume, eye } = view
  const { uniforms } = air
  const direction = view.toMapped(rayView).normalize().toConst() as Vec3
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const cosViewSun = direction.dot(view.sunDirection).clamp(-1, 1).toConst() as Float
  const { radiance, transmittance, limits } = skyInDirection(air, volume, eye, cosView, cosViewSun)
  const sky = linearSRGB(uniforms, radiance)
  if (pixel === null) return sky
  const disc = sunDisc(uniforms, direction, view.sunDirection, pixel)
  const sun = linearSRGB(uniforms, disc.mul(transmittance))
  return sky.add(limits.hitsGround.select(vec3(0), sun)).min(BRIGHTEST)
}
