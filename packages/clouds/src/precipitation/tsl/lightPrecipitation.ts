import type { ScatteringPhase } from '@welkin/atmosphere'
import { float, mix, vec3, vec4 } from 'three/tsl'
import type { CloudSample } from '../../density/tsl/sample'
import { cloudAmbientShares, cloudSource, litGround } from '../../light/tsl/cloudLight'
import { henyeyGreenstein, singlePhase } from '../../light/tsl/cloudPhase'
import { groundAlbedo, lightAt, shade } from '../../light/tsl/lighting'
import type { ShadingContext } from '../../light/tsl/shadingContext'
import type { Float, Vec3, Vec4 } from '../../tsl-types'
import { DIFFRACTED } from '../fallForm'
import type { SeenPrecipitation } from './marchPrecipitation'

/** Asymmetry of rain without what is only diffracted, g = 0.905 by Mie's theory: 2g − 1. */
const ASYMMETRY = 0.81

/** Lobes of the same moment, for flakes and stones, and for drops without a phase function: asymmetries, and the first one's share. */
const LOBES = [0.88, -0.1, 0.93] as const

/** Greatest phase function [1/sr]: sharper is only what diffraction makes, which counts as not scattered. */
const GREATEST = 12

/** Radius of clouds over what falls from them, over the period of their weather: they hide its sky, and it is as wide. */
export const CLOUD_RADIUS = 0.15

/** Clouds above what is seen. */
export interface CloudsAbove {
  /** Scaled optical depth of the strongest columns, straight up. */
  readonly depth: Float
  /** 1 for a deck, 0 for clouds as wide as they are deep. */
  readonly layered: Float
  readonly baseAltitude: Float
  /** Period of their weather [m]. */
  readonly period: Float
}

/**
 * Light that precipitation on a ray scatters to the camera, over the irradiance of the bare sun [1/sr]. To be called inside of a shader function.
 *
 * Light scattered once has the phase function of drops, and with it the bow, where it arrives unscattered. Light scattered more often
 * is that of a slab of the clouds above and of precipitation, of as many scatterings as turn light around: depths times (1 − g)/(1 − g′).
 *
 * @param drops - Phase function of raindrops; null for smooth lobes.
 * @param cast - Part of the light that casters besides the clouds leave, in [0, 1].
 */
export function lightPrecipitation(
  context: ShadingContext,
  drops: ScatteringPhase | null,
  direction: Vec3,
  seen: SeenPrecipitation,
  { depth, layered, baseAltitude, period }: CloudsAbove,
  cast: Float = float(1)
): Vec4 {
  const { field, light } = context
  const { distance, weight, rank, depthToLight, ownDepth, lit } = seen
  const offset = direction.mul(distance).toConst() as Vec3
  const sample: CloudSample = { offset, ...field.view.localCoordinates(offset), distance }
  const source = lightAt(context, sample)
  const cosView = sample.up.dot(direction).clamp(-1, 1).toConst() as Float
  const cosViewLight = direction.dot(source.direction).clamp(-1, 1).toConst() as Float
  const alike = float(1 - ASYMMETRY).div(light.oneMinusAsymmetry)
  const own = ownDepth.mul(alike).toConst() as Float
  const toLight = depthToLight.add(own).toConst() as Float
  const through = toLight.add(own).toConst() as Float
  const nodes = {
    depthToLight: toLight,
    depthThrough: through,
    depthAcross: through,
    depthToCamera: float(0),
    layered,
    cosLight: source.cosine,
    cosView,
    cosViewLight
  }
  // Less what the table's particles scatter once.
  const often = cloudSource(light, nodes).sub(
    singlePhase(light, cosViewLight, toLight).mul(light.scatteringScale).mul(toLight.negate().exp())
  )
  const [g, back, share] = LOBES
  const smooth = mix(
    henyeyGreenstein(float(back), cosViewLight),
    henyeyGreenstein(float(g), cosViewLight),
    share
  ).toConst() as Float
  const angles = { cosViewLight, cosView, cosLight: source.cosine }
  const phase = drops
    ? drops
        .phase(angles)
        .div(1 - DIFFRACTED)
        .min(GREATEST)
    : vec4(smooth)
  const once = phase.mul(lit.x).add(smooth.min(GREATEST).mul(lit.y))
  const under = cloudAmbientShares(light, {
    depthAbove: depth.mul(rank).add(own),
    depthBelow: own,
    layered,
    cosView
  })
  // Clouds as wide as they are deep hide less of the sky the deeper one is below them.
  const radius = period.mul(CLOUD_RADIUS).toConst() as Float
  const fall = baseAltitude.sub(sample.altitude).max(0).div(radius).toConst()
  const hidden = mix(fall.mul(fall).add(1).reciprocal(), 1, layered)
  const sky = mix(0.5, under.sky, hidden)
  const ground = mix(0.5, under.ground, hidden).mul(
    litGround(light, { ...nodes, ...sample, radius, albedo: groundAlbedo(field) })
  )
  const shares = vec3(often.max(0).mul(cast), sky, ground).mul(weight).toConst() as Vec3
  return shade(field, sample, shares, once.mul(cast))
}
