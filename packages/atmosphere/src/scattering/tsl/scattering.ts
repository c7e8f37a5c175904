import { float, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { loop, type Float, type Int, type Vec4 } from '../../tsl-types'
import { RADIANCE_SCALE } from '../../tables/tableSizes'
import { altitudeAlong } from '../../air/tsl/boundary'
import { diffuseMoments, groundIrradiance } from '../../diffuseLight/tsl/diffuseLight'
import { densities, extinction } from '../../air/tsl/medium'
import { applyMoments, momentBasis } from '../../diffuseLight/tsl/moments'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import { sunTransmittance } from '../../transmittance/tsl/transmittance'

/** Everything that says how the air scatters: its parameters and the two tables. */
export interface Air {
  uniforms: AtmosphereUniforms
  /** Optical depth to the top of the air. */
  transmittance: TextureNode
  /** Diffuse-light table; without it there is no light but the sun's. */
  diffuse: TextureNode | null
}

/** A ray in the mapped, spherical space: four numbers are all that matters by symmetry. */
export interface Ray {
  /** Origin above the ground, in [0, thickness] [m]. */
  altitude: Float
  /** μ, ray against zenith, at the origin. */
  cosView: Float
  /** μ_s, sun against zenith, at the origin. */
  cosSun: Float
  /** ν, ray against sun. */
  cosViewSun: Float
}

/** Light scattered towards a ray's origin, for unit irradiance of the sun, times `RADIANCE_SCALE`. */
export interface Scattered {
  /** Light by molecules, and by aerosols what was scattered before [1/sr]. */
  molecular: Vec4
  /** Light by aerosols straight from the source, without the phase function [1]. */
  aerosol: Vec4
}

/** Legendre coefficient χ₂ of Rayleigh scattering; χ₁ is 0. */
const RAYLEIGH_MOMENT_2 = 1 / 10

/** Parts of the light that a march takes into account. */
export interface LightSources {
  sun: boolean
  diffuse: boolean
}

/** Cosines and altitude at a distance along a ray. */
export function pointAlong({ uniforms }: Air, ray: Ray, distance: Float) {
  const { bottomRadius } = uniforms
  const radius = bottomRadius.add(ray.altitude)
  const altitude = altitudeAlong(ray.altitude, ray.cosView, distance, bottomRadius).max(0).toConst()
  const inverse = bottomRadius.add(altitude).reciprocal().toConst()
  return {
    altitude: altitude as Float,
    cosView: radius.mul(ray.cosView).add(distance).mul(inverse).clamp(-1, 1).toConst() as Float,
    cosSun: radius
      .mul(ray.cosSun)
      .add(distance.mul(ray.cosViewSun))
      .mul(inverse)
      .clamp(-1, 1)
      .toConst() as Float
  }
}

/** Source function at a point of a ray: light scattered into it per metre. */
function source(
  air: Air,
  ray: Ray,
  distance: Float,
  density: ReturnType<typeof densities>,
  lights: LightSources
): Scattered {
  const { uniforms } = air
  const point = pointAlong(air, ray, distance)
  const byMolecules = uniforms.rayleighScattering.mul(density.x).toConst()
  const byAerosols = uniforms.mieScattering.mul(density.y).toConst()
  let molecular: Vec4 = vec4(0)
  let aerosol: Vec4 = vec4(0)
  if (lights.sun) {
    const sunlight = sunTransmittance(uniforms, air.transmittance, point.altitude, point.cosSun)
      .mul(RADIANCE_SCALE)
      .toConst()
    molecular = byMolecules.mul(sunlight).mul(rayleighPhase(ray.cosViewSun))
    aerosol = byAerosols.mul(sunlight)
  }
  if (lights.diffuse && air.diffuse !== null) {
    const moments = diffuseMoments(uniforms, air.diffuse, point.altitude, point.cosSun)
    const basis = momentBasis(point.cosView, point.cosSun, ray.cosViewSun)
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
  lights: LightSources
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
  const near = source(air, ray, first.distance, first.density, lights)
  const far = source(air, ray, second.distance, second.density, lights)
  const toNear = attenuation(DEPTH_TO_NODE_1)
  const toFar = attenuation(DEPTH_TO_NODE_2)
  return {
    molecular: near.molecular.mul(toNear).add(far.molecular.mul(toFar)),
    aerosol: near.aerosol.mul(toNear).add(far.aerosol.mul(toFar)),
    depth
  }
}

/** Growth of a march's steps over that of the scale height of molecules: larger puts more steps low. */
const STEP_GROWTH = 0.3

/**
 * κ of a way's steps, see {@link march}; never 0, where they would be 0/0.
 *
 * @param rise - Altitude at the end of the way less that at its start [m].
 */
export function stepExponent({ homogeneousHeight }: AtmosphereUniforms, rise: Float): Float {
  const wanted = rise.div(homogeneousHeight).mul(STEP_GROWTH).clamp(-4, 4)
  return wanted.abs().max(0.05).mul(wanted.lessThan(0).select(-1, 1))
}

/**
 * Cuts a way into steps, t(x) = t_max (e^{κx} − 1)/(e^κ − 1): short where the air is dense, at the
 * lower end of the way.
 *
 * @param distance - Length of the way [m].
 * @param rise - Altitude at its end less that at its start [m].
 * @param step - Called with the distances at which a step starts and ends [m].
 */
export function march(
  uniforms: AtmosphereUniforms,
  distance: Float,
  rise: Float,
  steps: number | Int,
  step: (start: Float, end: Float) => void
): void {
  const exponent = stepExponent(uniforms, rise).toConst()
  const scale = distance.div(exponent.exp().sub(1)).toConst()
  const inverse = float(1)
    .div(float(steps as number))
    .toConst()
  const start = float(0).toVar()
  loop('step', steps, index => {
    const x = float(index).add(1).mul(inverse)
    const end = exponent.mul(x).exp().sub(1).mul(scale).toConst() as Float
    step(start, end)
    start.assign(end)
  })
}

/**
 * Light scattered along a ray, by marching it: the reference for the sky volume, and for rays that
 * start anywhere.
 *
 * @param air - Parameters and tables.
 * @param ray - In the air; it must not cross the ground before `distance`.
 * @param distance - Length of the march [m].
 * @param rise - Altitude at its end less that at its start [m].
 * @param steps - Two evaluations each; 12 are within 0.1 % by day.
 * @param lights - Light to take into account.
 * @returns Light scattered to the ray's origin, and optical depth of the way.
 */
export function scattering(
  air: Air,
  ray: Ray,
  distance: Float,
  rise: Float,
  steps: number | Int,
  lights: LightSources = { sun: true, diffuse: true }
): Scattered & { depth: Vec4 } {
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const depth = vec4(0).toVar()
  march(air.uniforms, distance, rise, steps, (start, end) => {
    const segment = scatterSegment(air, ray, start, end, lights)
    const through = depth.negate().exp().toConst()
    molecular.addAssign(segment.molecular.mul(through))
    aerosol.addAssign(segment.aerosol.mul(through))
    depth.addAssign(segment.depth)
  })
  return { molecular, aerosol, depth }
}

/** Adds both parts with the aerosols' phase function, and takes the table's scale out [1/sr]. */
export function scatteredRadiance(
  uniforms: AtmosphereUniforms,
  scattered: Scattered,
  cosViewSun: Float
): Vec4 {
  return scattered.molecular
    .add(scattered.aerosol.mul(miePhase(uniforms, cosViewSun)))
    .mul(1 / RADIANCE_SCALE)
}

/**
 * Radiance of the Lambertian ground, for unit irradiance of the sun [1/sr].
 *
 * @param cosSun - μ_s at the ground.
 * @param lights - Light to take into account.
 */
export function groundRadiance(
  air: Air,
  cosSun: Float,
  lights: LightSources = { sun: true, diffuse: true }
): Vec4 {
  const { uniforms } = air
  let irradiance: Vec4 = vec4(0)
  if (lights.sun) {
    irradiance = sunTransmittance(uniforms, air.transmittance, float(0), cosSun).mul(cosSun.max(0))
  }
  if (lights.diffuse && air.diffuse !== null) {
    irradiance = irradiance.add(groundIrradiance(uniforms, air.diffuse, cosSun))
  }
  return irradiance.mul(uniforms.groundAlbedo).mul(1 / Math.PI)
}
