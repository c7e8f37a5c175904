import { If, float, int, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { densities } from '../../air/tsl/medium'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import { pointAlong } from '../../scattering/tsl/ray'
import { rayLimits } from '../../skyVolume/tsl/rayLimits'
import { EXTINCTION_SCALE, meanExtinction } from '../../skyVolume/tsl/meanExtinction'
import { viewRay } from '../../skyVolume/tsl/viewRay'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'
import { slicePosition } from '../../skyVolume/tsl/volumeMapping'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import { loop, type Bool, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import type { ViewUniforms } from '../../view/ViewUniforms'
import { occluderAngleAt, polarRay, type PolarFrame } from './polarMap'
import { warpedSteps } from './warpedSteps'

/** Sun-polar shadow map, as shaders read it. */
export interface ShadowedAir {
  readonly map: TextureNode
  readonly frame: PolarFrame
  /** Greatest ρ at which there may be shadows [m]. */
  readonly maximumRho: Float
}

/** A view ray, and as far as it is marched. */
export interface ShaftRay {
  /** Unit length, in the mapped space. */
  readonly direction: Vec3
  readonly cosView: Float
  /** ν, against the source of light. */
  readonly cosViewLight: Float
  /** Distance to what is seen; beyond the air for the sky [m]. */
  readonly distance: Float
}

/** Number of samples on a ray. */
export interface ShaftSteps {
  /** Places at which the lit air is evaluated, if they are in shadow. */
  readonly groups: Float
  /** Look-ups of the shadow for each. */
  readonly samples: Float
}

/**
 * Single scattering that shadows keep from a view ray, for unit irradiance of the source [1/sr]:
 * ∫ σ_s p(ν) T_light T_view over the dark parts of the ray.
 *
 * The ray is cut into groups of samples, spaced so that each holds about the same light. In each the look-ups
 * give the dark part and its centre; there the light is evaluated once, which is exact where it varies linearly.
 *
 * @param jitter - Place of samples in their steps, in (0, 1).
 */
export function lostLight(
  view: ViewUniforms,
  { map, frame, maximumRho }: ShadowedAir,
  { direction, cosView, cosViewLight, distance }: ShaftRay,
  { groups, samples }: ShaftSteps,
  jitter: Float
): Vec4 {
  const { air, viewpoint, volume } = view
  const { uniforms } = air
  const limits = rayLimits(viewpoint, cosView)
  const polar = polarRay(frame, direction, cosViewLight)
  const end = limits.start.add(limits.length).min(distance).min(maximumRho.div(polar.sinViewLight))
  const length = end.sub(limits.start).toConst() as Float
  const lost = vec4(0).toVar()
  If(length.greaterThan(0), () => {
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
    const steps = warpedSteps(uniforms, ray, length)
    const elevation = viewRay(viewpoint, cosView, limits.hitsGround)
    const phases = [rayleighPhase(cosViewLight), miePhase(uniforms, cosViewLight)] as const
    const rayleigh = uniforms.rayleighScattering.mul(phases[0]).toConst()
    const mie = uniforms.mieScattering.mul(phases[1]).toConst()
    const perGroup = float(1).div(groups).toConst()
    const perSample = float(1).div(samples).toConst()
    loop('group', int(groups), group => {
      const dark = float(0).toVar()
      const sum = float(0).toVar()
      loop('look', int(samples), look => {
        const part = float(look).add(jitter).mul(perSample).add(float(group)).mul(perGroup)
        const position = part.toConst() as Float
        const fromAxis = steps.distance(position).add(limits.start).mul(polar.sinViewLight)
        const occluder = occluderAngleAt(map, frame, polar.row, fromAxis)
        If(polar.angle.greaterThan(occluder), () => {
          dark.addAssign(1)
          sum.addAssign(position)
        })
      })
      If(dark.greaterThan(0), () => {
        const centre = sum.div(dark).toConst() as Float
        const inAir = steps.distance(centre).toConst() as Float
        const width = steps.slope(centre).mul(dark).mul(perSample.mul(perGroup))
        const place = pointAlong(air, ray, inAir)
        const slice = slicePosition(viewpoint, limits, inAir)
        const extinction = meanExtinction(volume, viewpoint, elevation, slice)
        const through = extinction.mul(inAir.div(EXTINCTION_SCALE)).negate().exp()
        const density = densities(uniforms, place.altitude).toConst()
        const scattering = rayleigh.mul(density.x).add(mie.mul(density.y))
        const light = lightTransmittance(
          uniforms,
          air.transmittance,
          place.altitude.min(uniforms.thickness),
          place.cosLight
        )
        lost.addAssign(scattering.mul(light).mul(through).mul(width))
      })
    })
  })
  return lost
}

/** Places of samples in their steps, in 2 × 2 pixels: any four that touch have all of them. */
const STAGGERED = [0.125, 0.625, 0.875, 0.375]

/** Place of a pixel's samples in their steps. */
export function staggered(pixel: Vec2): Float {
  const [left, right, lowerLeft, lowerRight] = STAGGERED
  const odd = pixel.mod(2).greaterThan(vec2(0.5)).toConst() as unknown as { x: Bool; y: Bool }
  const upper = odd.x.select(right, left)
  return odd.y.select(odd.x.select(lowerRight, lowerLeft), upper).toConst()
}
