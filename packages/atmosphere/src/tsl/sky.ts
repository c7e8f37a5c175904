import { If, float, smoothstep, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec3, Vec4 } from '../tsl-types'
import type { SkyLayer, SkyRay } from '../SkyLayer'
import type { ViewNodes } from '../ViewNodes'
import { linearSRGB } from './color'
import { scatteredRadiance } from './scattering'
import { veiled } from './aerialPerspective'
import { rayTargets, sampleSky, skyTransmittance } from './skyVolume'
import { sine } from './trigonometry'

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
  const cosLimb = sine(part)
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

/** Light from beyond the air: the sun's disc, and the layers' in front of it [1/sr]. */
function lightBeyond(ray: SkyRay, reach: Float, layers: readonly SkyLayer[]): Vec4 {
  const { view, direction, cosViewSun, pixel } = ray
  const sun = vec4(0).toVar()
  If(cosViewSun.greaterThan(reach), () => {
    sun.assign(sunDisc(view.air.uniforms, direction, view.sunDirection, pixel))
  })
  return layers.reduce<Vec4>((light, layer) => layer.beyond?.(ray, light) ?? light, sun)
}

/**
 * Sky, ground, sun and the atmosphere's layers in a direction of view.
 *
 * @param rayView - Direction in view space, any length.
 * @param pixel - {@link pixelAngle} of it; null to leave out what is beyond the air: sun, moon, stars.
 * @returns Linear sRGB × `luminanceScale`.
 */
export function skyColor(view: ViewNodes, rayView: Vec3, pixel: Float | null): Vec3 {
  const { air, volume, eye } = view
  const { layers } = view.atmosphere
  const { uniforms } = air
  const direction = view.toMapped(rayView).normalize().toConst() as Vec3
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const cosViewSun = direction.dot(view.sunDirection).clamp(-1, 1).toConst() as Float
  const { hitsGround, meetsAir } = rayTargets(uniforms, eye, cosView)
  const radiance = vec4(0).toVar()
  If(meetsAir.and(view.isLit.greaterThan(0)), () => {
    const light = sampleSky(uniforms, volume, eye, cosView, cosViewSun, hitsGround)
    radiance.assign(scatteredRadiance(uniforms, light, cosViewSun).mul(view.source.irradiance))
  })
  const angles = { direction, cosView, cosViewSun, hitsGround, meetsAir }
  const ray: SkyRay = { view, ...angles, pixel: pixel ?? float(0), airlight: radiance }
  for (const layer of layers) {
    if (layer.ground !== undefined) radiance.assign(layer.ground(ray, radiance))
    if (layer.glow !== undefined) radiance.addAssign(layer.glow(ray))
  }
  const veil = veiled(ray, { depth: vec4(0), light: radiance })
  radiance.assign(veil.light)
  if (pixel !== null) {
    const reach = uniforms.sunAngularRadius.add(pixel).cos().sub(1e-6).toConst() as Float
    const isSomewhere = layers.some(layer => layer.beyond !== undefined)
    const isThere = isSomewhere
      ? hitsGround.not()
      : cosViewSun.greaterThan(reach).and(hitsGround.not())
    If(isThere, () => {
      const through = skyTransmittance(uniforms, volume, eye, cosView, hitsGround)
      const covered = through.mul(veil.depth.negate().exp())
      radiance.addAssign(lightBeyond(ray, reach, layers).mul(covered))
    })
  }
  return linearSRGB(uniforms, radiance).min(BRIGHTEST)
}
