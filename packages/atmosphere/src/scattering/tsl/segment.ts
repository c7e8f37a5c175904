import { vec4 } from 'three/tsl'
import { altitudeAlong } from '../../air/tsl/boundary'
import { densities, extinction } from '../../air/tsl/medium'
import { rayleighPhase } from '../../air/tsl/phase'
import { diffuseMoments } from '../../diffuseLight/tsl/diffuseLight'
import { applyMoments, momentBasis } from '../../diffuseLight/tsl/moments'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import type { Float, Vec4 } from '../../tsl-types'
import { pointAlong, type Air, type Ray } from './ray'

/** Light scattered towards a ray's origin, for unit irradiance of the light source, times `RADIANCE_SCALE`. */
export interface Scattered {
  /** Light by molecules, and by aerosols what was scattered before [1/sr]. */
  molecular: Vec4
  /** Light by aerosols straight from the source, without the phase function [1]. */
  aerosol: Vec4
}

/** Legendre coefficient χ₂ of Rayleigh scattering; χ₁ is 0. */
export const RAYLEIGH_MOMENT_2 = 1 / 10

/** Parts of the light that a march takes into account. */
export interface LightParts {
  /** Light straight from the source. */
  direct: boolean
  /** Light that was scattered before, from the diffuse-light table. */
  diffuse: boolean
}

/** Source function at a point of a ray: light scattered into it per metre. */
export function sourceFunction(
  air: Air,
  ray: Ray,
  distance: Float,
  density: ReturnType<typeof densities>,
  lights: LightParts
): Scattered {
  const { uniforms } = air
  const point = pointAlong(air, ray, distance)
  const byMolecules = uniforms.rayleighScattering.mul(density.x).toConst()
  const byAerosols = uniforms.mieScattering.mul(density.y).toConst()
  let molecular: Vec4 = vec4(0)
  let aerosol: Vec4 = vec4(0)
  if (lights.direct) {
    const sunlight = lightTransmittance(uniforms, air.transmittance, point.altitude, point.cosLight)
      .mul(RADIANCE_SCALE)
      .toConst()
    molecular = byMolecules.mul(sunlight).mul(rayleighPhase(ray.cosViewLight))
    aerosol = byAerosols.mul(sunlight)
  }
  if (lights.diffuse && air.diffuse !== null) {
    const moments = diffuseMoments(uniforms, air.diffuse, point.altitude, point.cosLight)
    const basis = momentBasis(point.cosView, point.cosLight, ray.cosViewLight)
    molecular = molecular
      .add(byMolecules.mul(applyMoments(moments, basis, 0, RAYLEIGH_MOMENT_2)))
      .add(byAerosols.mul(applyMoments(moments, basis, uniforms.mieMoment1, uniforms.mieMoment2)))
  }
  return { molecular, aerosol }
}

const INVERSE_ROOT_3 = 1 / Math.sqrt(3)

/** Nodes of the two-point Gauss–Legendre rule on [0, 2]. */
const NODES = [1 - INVERSE_ROOT_3, 1 + INVERSE_ROOT_3]

/**
 * Optical depth from the start of a segment to a node, of the line through both nodes' extinctions:
 * half × (first × extinction₁ + second × extinction₂).
 */
const DEPTH_TO_NODE_1 = [0.5, 0.5 - INVERSE_ROOT_3] as const
const DEPTH_TO_NODE_2 = [0.5 + INVERSE_ROOT_3, 0.5] as const

/** Extinctions at the two nodes of a segment, and their sum times half its length. */
export function segmentDepth(air: Air, ray: Ray, start: Float, end: Float) {
  const half = end.sub(start).mul(0.5).toConst()
  const { bottomRadius } = air.uniforms
  const [first, second] = NODES.map(node => {
    const distance = start.add(half.mul(node)).toConst() as Float
    const altitude = altitudeAlong(ray.altitude, ray.cosView, distance, bottomRadius).max(0)
    const density = densities(air.uniforms, altitude.toConst()).toConst()
    return { distance, density, extinction: extinction(air.uniforms, density).toConst() }
  }) as unknown as [NodeOnRay, NodeOnRay]
  const depth = first.extinction.add(second.extinction).mul(half).toConst() as Vec4
  return { half: half as Float, first, second, depth }
}

interface NodeOnRay {
  distance: Float
  density: ReturnType<typeof densities>
  extinction: Vec4
}

/**
 * Light scattered in a segment of a ray, as seen from the segment's start, by a two-point rule.
 *
 * @returns Light, and optical depth of the segment.
 */
export function scatterSegment(
  air: Air,
  ray: Ray,
  start: Float,
  end: Float,
  lights: LightParts
): Scattered & { depth: Vec4 } {
  const { half, first, second, depth } = segmentDepth(air, ray, start, end)
  const attenuation = (weights: readonly [number, number]): Vec4 =>
    first.extinction
      .mul(weights[0])
      .add(second.extinction.mul(weights[1]))
      .mul(half)
      .max(0)
      .negate()
      .exp()
      .mul(half)
      .toConst()
  const near = sourceFunction(air, ray, first.distance, first.density, lights)
  const far = sourceFunction(air, ray, second.distance, second.density, lights)
  const toNear = attenuation(DEPTH_TO_NODE_1)
  const toFar = attenuation(DEPTH_TO_NODE_2)
  return {
    molecular: near.molecular.mul(toNear).add(far.molecular.mul(toFar)),
    aerosol: near.aerosol.mul(toNear).add(far.aerosol.mul(toFar)),
    depth
  }
}
