import { If, float, smoothstep, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import type { Bool, Float, Vec3, Vec4 } from '../../tsl-types'
import type { SkyLayer, SkyRay } from '../../view/SkyLayer'
import type { ViewNodes } from '../../view/ViewNodes'
import { linearSRGB } from '../../air/tsl/color'
import { withMedia } from './aerialPerspective'
import { skyTransmittance } from '../../skyVolume/tsl/meanExtinction'
import { sampleSky } from '../../skyVolume/tsl/skyVolume'
import { viewRay } from '../../skyVolume/tsl/viewRay'
import { rayTargets } from '../../skyVolume/tsl/rayLimits'
import { sine } from '../../math/tsl/trigonometry'

/**
 * Radiance of the sun's disc above the air, for unit irradiance [1/sr].
 *
 * The limb darkens as I(ρ) ∝ 1 − u (1 − √(1 − ρ²)), normalised so that the disc gives the irradiance.
 *
 * @param direction - View direction, of unit length.
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

/**
 * Angle between a fragment's line of sight and that of the one diagonally next to it [rad]. Not for use in
 * branches.
 *
 * @param direction - Direction of unit length, in any frame.
 */
export function pixelAngle(direction: Vec3): Float {
  const [across, up] = [direction.dFdx().toConst(), direction.dFdy().toConst()]
  return across.dot(across).add(up.dot(up)).sqrt().toConst()
}

/**
 * Sky, ground, sun and the atmosphere's layers in a direction of view.
 *
 * @param direction - In the mapped space, unit length.
 * @param pixel - {@link pixelAngle} of it; null to leave out what is beyond the air: sun, moon, stars.
 * @param layers - Sky layers, and shadows in the air; by default the atmosphere's layers.
 * @param lost - Light that shadows take from the air, linear sRGB × `luminanceScale`; by default none.
 * @returns Linear sRGB × `luminanceScale`.
 */
export function skyColor(
  view: ViewNodes,
  direction: Vec3,
  pixel: Float | null,
  layers: readonly SkyLayer[] = view.atmosphere.layers,
  lost?: Vec3
): Vec3 {
  const { air, volume, viewpoint } = view
  const { uniforms } = air
  const cosView = direction.dot(view.up).clamp(-1, 1).toConst() as Float
  const cosViewLight = direction.dot(view.lightDirection).toConst() as Float
  const { hitsGround, meetsAir } = rayTargets(viewpoint, cosView)
  const volumeRay = viewRay(viewpoint, cosView, hitsGround)
  const radiance = vec4(0).toVar()
  If(meetsAir.and(view.isLit.greaterThan(0)), () => {
    const light = sampleSky(uniforms, volume, viewpoint, volumeRay, cosViewLight)
    radiance.assign(light.mul(view.source.irradiance))
  })
  const angles = { direction, cosViewLight, meetsAir, ...volumeRay }
  const ray: SkyRay = { view, ...angles, pixel: pixel ?? float(0), airlight: radiance }
  for (const layer of layers) {
    if (layer.ground !== undefined) radiance.assign(layer.ground(ray, radiance))
    if (layer.glow !== undefined) radiance.assign(layer.glow(ray, radiance))
  }
  const medium = withMedia(layers, ray, { depth: vec4(0), radiance })
  radiance.assign(medium.radiance)
  const far = vec4(0).toVar()
  let isDimmed: Bool | null = null
  if (pixel !== null) {
    // cos x > 1 − x²/2, and no more than that by far.
    const largestAngle = uniforms.sunAngularRadius.add(pixel).toConst()
    const isNear = cosViewLight.greaterThan(
      largestAngle
        .mul(largestAngle)
        .mul(-0.5)
        .add(1 - 1e-6)
    )
    isDimmed = isNear.and(hitsGround.not()).toConst()
    If(isDimmed, () => {
      far.assign(sunDisc(uniforms, direction, view.lightDirection, pixel))
    })
    if (layers.some(layer => layer.background !== undefined)) {
      If(hitsGround.not(), () => {
        for (const layer of layers) far.assign(layer.background?.(ray, far) ?? far)
      })
      isDimmed = far.dot(vec4(1)).greaterThan(0)
    }
  }
  const below = layers.flatMap(layer => layer.below?.(ray) ?? [])
  for (const { isSeen } of below) isDimmed = isDimmed?.or(isSeen) ?? isSeen
  if (isDimmed !== null) {
    If(isDimmed, () => {
      const through = skyTransmittance(volume, viewpoint, volumeRay)
      const first: Vec4 = far.mul(through)
      const light = below.reduce((sum, each) => sum.add(each.light(through)), first)
      radiance.addAssign(light.mul(medium.depth.negate().exp()))
    })
  }
  return linearSRGB(uniforms, radiance, lost).min(BRIGHTEST)
}
