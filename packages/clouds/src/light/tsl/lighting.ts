import { horizontalIrradiance, transmittanceToLight } from '@welkin/atmosphere'
import { If, float, mix, smoothstep } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import { footprintOf, type CloudSample } from '../../density/tsl/sample'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { facingFit } from '../cpu/facing'
import { lateralLeakFit as fit } from '../cpu/lateralLeak'
import { cloudAmbientShares, cloudSource, litGround } from './cloudLight'
import { localDepths } from './localDepths'
import { isNight, nightShare } from './night'
import type { ShadedSample, ShadingContext, ShadingLight } from './shadingContext'

/**
 * Transmittance below which a ray ends: what is behind is not seen. Greater: the sun's disc is cut off
 * sharply by clouds (*Cumulus*).
 */
export const LEAST_TRANSMITTANCE = 0.01

/** Source function of a place, as shares of the light that reaches it: per scaled extinction. */
export interface CloudShares {
  /** Share of the irradiance of the sun, or of the moon where that is the light [1/sr]. */
  direct: Float
  /** Shares of the mean radiance of the upper and of the lower hemisphere [1]. */
  sky: Float
  ground: Float
  /** Bows and rings of droplets and crystals, at the four wavelengths: comes on top of `direct` [1/sr]. */
  fine?: Vec4
}

/** The light of a place: the moon where it is night, or else the sun. */
export function lightAt({ field, shadows }: ShadingContext, { up }: CloudSample): ShadingLight {
  const { view, night } = field
  const isMoonlit = isNight(field, up.dot(view.lightDirection)).toConst()
  const direction = select(isMoonlit, night.moonDirection, view.lightDirection).toConst() as Vec3
  const isMapped = select(isMoonlit, shadows.isMoonlit, shadows.isMoonlit.oneMinus()) as Float
  const cosine = up.dot(direction).clamp(-1, 1).toConst() as Float
  return { direction, isMoonlit, isMapped, cosine }
}

/** Albedo of the ground in green light. */
export const groundAlbedo = ({ view }: CloudField): Float =>
  (view.air.uniforms.groundAlbedo as unknown as Vec4).y

/** Source function of a place towards the viewpoint: the light that it scatters there. */
export function sourceAt(context: ShadingContext, shaded: ShadedSample): CloudShares {
  const { light } = context
  const { sample, direction, transmittance, past, lit: cast = float(1) } = shaded
  const source = lightAt(context, sample)
  const cosView = sample.up.dot(direction).clamp(-1, 1).toConst() as Float
  const cosViewLight = direction.dot(source.direction).clamp(-1, 1).toConst() as Float
  const depths = localDepths(context, shaded, source)
  const scale = light.depthScale
  const layered = shaded.layers.layered.toConst() as Float
  const depthThrough = depths.through.mul(scale).toConst() as Float
  const seen = transmittance.max(LEAST_TRANSMITTANCE).toConst() as Float
  const depthToCamera = seen.log().negate().toConst() as Float
  const depthBehind = seen.div(past.max(LEAST_TRANSMITTANCE)).log().max(0).toConst() as Float
  const depthAbove = depths.above.mul(scale).toConst() as Float
  const depthBelow = depths.below.mul(scale).toConst() as Float
  const { top, base } = shaded.layers
  // Clouds are about as wide as their layer is thick.
  const cloudWidth = top.sub(base).max(1).toConst()
  const footprint = footprintOf(context.field, sample).toConst() as Float
  const resolved = footprint.div(cloudWidth).oneMinus().clamp().toConst() as Float
  const [level, rise] = fit.unresolvedDiameter
  const unresolved = source.cosine.abs().mul(rise).add(level)
  const lit = {
    depthToLight: depths.toLight.mul(scale).toConst() as Float,
    depthThrough,
    depthAcross: depthThrough.mul(mix(unresolved, fit.diameterPerChord, resolved)),
    depthToCamera,
    layered,
    cosLight: source.cosine,
    cosView,
    cosViewLight,
    viewChord: [depthToCamera, depthBehind] as const,
    verticalChord: [depthAbove, depths.likelyBelow.mul(scale).toConst() as Float] as const,
    filled: depths.filled,
    resolved: mix(fit.unresolvedChords, 1, resolved) as Float,
    faces: smoothstep(...facingFit.footprints, footprint).oneMinus() as Float
  }
  const direct = cloudSource(light, lit)
  const fine = light.fineStructure?.({ ...lit, altitude: sample.altitude })
  const ambient = cloudAmbientShares(light, {
    depthAbove,
    depthBelow,
    layered,
    cosView,
    resolved
  })
  const below = litGround(light, {
    ...lit,
    ...sample,
    radius: cloudWidth.div(2),
    albedo: groundAlbedo(context.field)
  })
  return {
    direct: direct.mul(cast),
    sky: ambient.sky,
    ground: ambient.ground.mul(below),
    fine: fine?.mul(cast)
  }
}

/**
 * Shades clouds around a place: their spectral radiance in the light of sun, moon and night sky, over the sun's
 * irradiance above the air [1/sr].
 *
 * @param shares - Sums of `CloudShares`.
 * @param fine - Sum of their fine structure, if there is any.
 */
export function shade(
  field: CloudField,
  { altitude, up }: CloudSample,
  shares: Vec3,
  fine?: Vec4
): Vec4 {
  const { view } = field
  const { uniforms, transmittance, diffuse } = view.air
  const { night } = field
  const litFrom = (direction: Vec3): { cosine: Float; light: Vec4 } => {
    const cosine = up.dot(direction).clamp(-1, 1).toConst() as Float
    const arriving = transmittanceToLight(uniforms, transmittance, altitude, cosine)
    const scattered = fine === undefined ? shares.x : fine.add(shares.x).max(0)
    const direct = arriving.mul(scattered) as Vec4
    if (diffuse === null) return { cosine, light: direct }
    const irradiance = horizontalIrradiance(uniforms, diffuse, altitude, cosine)
    const ambient = irradiance.up.mul(shares.y).add(irradiance.down.mul(shares.z))
    return { cosine, light: direct.add(ambient.mul(field.ambient).div(Math.PI)) }
  }
  const sun = litFrom(view.lightDirection)
  const light = sun.light.mul(view.source.irradiance).toVar() as Vec4
  If(isNight(field, sun.cosine), () => {
    const moonlight = litFrom(night.moonDirection).light.mul(night.moonIrradiance)
    const shine = uniforms.groundAlbedo.mul(shares.z).add(shares.y)
    const sky = night.skyRadiance.mul(shine).mul(field.ambient)
    light.addAssign(moonlight.add(sky).mul(nightShare(field, sun.cosine)))
  })
  return light
}
