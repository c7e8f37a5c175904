import { If, float, int, vec2, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import type { Air } from '../../scattering/tsl/ray'
import { rayLimits } from '../../skyVolume/tsl/rayLimits'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import { loop, type Bool, type Float, type Vec2, type Vec3, type Vec4 } from '../../tsl-types'
import type { ViewUniforms } from '../../view/ViewUniforms'
import type { AirPlace, AirShadow } from '../AirOccluder'
import { litRay, type RayPlace } from './litRay'
import { lostDiffuse } from './lostDiffuse'
import { isDark, polarRay, type PolarFrame, type PolarRay } from './polarMap'
import { warpedSteps, type WarpedSteps } from './warpedSteps'

/** Shadows in the air, as shaders read them: the sun-polar shadow map, and what reaches beyond it. */
export interface ShadowedAir {
  readonly map: TextureNode
  readonly frame: PolarFrame
  /** Greatest ρ at which the map may have shadows [m]. */
  readonly maximumRho: Float
  /** Shadows of clouds and the like. */
  readonly shadows: readonly Pick<AirShadow, 'transmittance' | 'diffuse'>[]
  /** World position of a displacement from the camera in the mapped space [m]. */
  readonly toWorld: (offset: Vec3) => Vec3
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
  /** Part of the light from a distance [m] that reaches the picture; left out, all. */
  readonly seenFrom?: (distance: Float) => Float
}

/** Number of samples on a ray. */
export interface ShaftSteps {
  /** Places at which the lit air is evaluated, if they are in shadow. */
  readonly groups: Float
  /** Look-ups of the shadow for each. */
  readonly samples: Float
}

/** Places at which diffuse light is evaluated, over groups: it changes slowly, and four pixels share theirs. */
const DIFFUSE_PART = 0.5

/** Stretch of a ray that is marched in groups of samples, whatever its length. */
interface Stretch {
  /** Light of the ray before it, and in it, as parts of all. */
  readonly from: Float
  readonly width: Float
  /** Number of groups, and of samples in each. */
  readonly groups: Float
  readonly samples: Float
  /** True where the map has shadows; null where all of the ray is. */
  readonly isMapped: Bool | null
}

/** What is marched of a view ray. */
interface March {
  readonly steps: WarpedSteps
  /** Part of a place's light that the picture loses, by position among the steps. */
  readonly darkAt: (position: Float, isMapped: Bool | null) => Float
  /** Light scattered once at a distance in the air, if nothing casts shadows [1/(m sr)]. */
  readonly scatteredAt: (inAir: Float) => Vec4
  readonly jitter: Float
}

/**
 * Single scattering that shadows keep from a view ray, for unit irradiance of the source [1/sr]:
 * ∫ σ_s p(ν) T_light T_view (1 − V) over the ray, where V is the part of the light that occluders let through. Besides
 * {@link lostDiffuse}, if there are occluders that dim diffuse light.
 *
 * The ray is cut into groups of samples, spaced so that each holds about the same light. In each the look-ups
 * give the dark part and its centre; there the light is evaluated once, which is exact where it varies linearly.
 * Where there are shadows beyond the map, the ray goes on there with about as many samples again.
 *
 * @param jitter - Place of samples in their steps, in (0, 1).
 */
export function lostLight(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  shaftRay: ShaftRay,
  { groups, samples }: ShaftSteps,
  jitter: Float
): Vec4 {
  const { air, viewpoint } = view
  const { maximumRho, shadows } = shadowedAir
  const { cosView, cosViewLight, distance } = shaftRay
  const limits = rayLimits(viewpoint, cosView)
  const polar = polarRay(shadowedAir.frame, shaftRay.direction, cosViewLight)
  const mapped = maximumRho.div(polar.sinViewLight).toConst() as Float
  const isMappedOnly = shadows.length === 0
  const seen = limits.start.add(limits.length).min(distance)
  const end = isMappedOnly ? seen.min(mapped) : seen
  const length = end.sub(limits.start).toConst() as Float
  const lost = vec4(0).toVar()
  If(length.greaterThan(0), () => {
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
    const steps = warpedSteps(air.uniforms, ray, length)
    const airAt = litRay(view, ray, limits, cosView)
    const { darkAt, missingAt } = shadowsAlong(view, shadowedAir, shaftRay, polar, jitter)
    const fromEye = (inAir: Float): Float => inAir.add(limits.start).toConst()
    const march: March = {
      steps,
      darkAt: (position, isMapped) => darkAt(fromEye(steps.distance(position)), isMapped),
      scatteredAt: scatteredOnce(air, airAt, cosViewLight),
      jitter
    }
    if (isMappedOnly) {
      const all = { from: float(0), width: float(1), groups, samples, isMapped: null }
      loop('group', int(groups), group => {
        lost.addAssign(lostInGroup(march, all, float(group)))
      })
      return
    }
    const near = steps.partAt(mapped.sub(limits.start).clamp(0, length)).toConst() as Float
    // Each has groups by its light, and as many samples whatever that is; beyond the map shadows are soft.
    const [first, rest] = [near, near.oneMinus()].map(
      width => groups.mul(width).ceil().toConst() as Float
    )
    const samplesOf = (all: Float, among: Float): Float => groups.mul(all).div(among.max(1)).ceil()
    const [many, few] = [samplesOf(samples, first), samplesOf(samples.sub(1), rest)].map(
      count => count.toConst() as Float
    )
    loop('group', int(first.add(rest)), group => {
      const index = float(group)
      const isMapped = index.lessThan(first).toConst() as Bool
      const choose = (a: Float | number, b: Float): Float => isMapped.select(a, b).toConst()
      const stretch = {
        from: choose(0, near),
        width: choose(near, near.oneMinus()),
        groups: choose(first, rest),
        samples: choose(many, few),
        isMapped
      }
      lost.addAssign(lostInGroup(march, stretch, choose(index, index.sub(first))))
    })
    if (missingAt === null) return
    const places = int(groups.mul(DIFFUSE_PART).max(1))
    const diffuse = {
      steps,
      at: airAt,
      cosViewLight,
      samples: places,
      jitter,
      missingAt: (inAir: Float) => missingAt(fromEye(inAir))
    }
    lost.addAssign(lostDiffuse(air, diffuse))
  })
  return lost
}

/** Shadows on a view ray, by the distance from the camera: the part of the light that the picture loses there. */
function shadowsAlong(
  view: ViewUniforms,
  { map, frame, shadows, toWorld }: ShadowedAir,
  { direction, seenFrom }: ShaftRay,
  polar: PolarRay,
  jitter: Float
): {
  darkAt: (distance: Float, isMapped: Bool | null) => Float
  /** Of light scattered more than once; null if there is none. */
  missingAt: ((distance: Float) => Vec4) | null
} {
  const placeAt = (distance: Float): AirPlace => {
    const offset = direction.mul(distance).toConst() as Vec3
    return { view, offset, distance, jitter, positionWorld: () => toWorld(offset) }
  }
  const passing = shadows.map(shadow => shadow.transmittance({ view, direction, jitter }))
  const dimming = shadows.filter(shadow => shadow.diffuse !== undefined)
  const missingAt = (distance: Float): Vec4 => {
    const parts = dimming.map(shadow => shadow.diffuse!(placeAt(distance)))
    const missing = parts.reduce((product, part) => product.mul(part)).oneMinus()
    return seenFrom === undefined ? missing : missing.mul(seenFrom(distance))
  }
  return {
    darkAt(distance, isMapped) {
      const dark = float(0).toVar()
      const readMap = (): void => {
        dark.assign(isDark(map, frame, polar, distance).select(1, 0))
      }
      if (isMapped === null) readMap()
      else If(isMapped, readMap)
      if (passing.length > 0) {
        If(dark.lessThan(1), () => {
          const place = placeAt(distance)
          const parts = passing.map(transmittance => transmittance(place))
          dark.assign(parts.reduce((product, part) => product.mul(part)).oneMinus())
        })
      }
      return seenFrom?.(distance).mul(dark) ?? dark
    },
    missingAt: dimming.length > 0 ? missingAt : null
  }
}

/** Light scattered once that a ray gains at a distance in the air, for unit irradiance [1/(m sr)]. */
function scatteredOnce(
  { uniforms, transmittance }: Air,
  airAt: (inAir: Float) => RayPlace,
  cosViewLight: Float
): (inAir: Float) => Vec4 {
  const rayleigh = rayleighPhase(cosViewLight).toConst()
  const mie = miePhase(uniforms, cosViewLight).toConst()
  return inAir => {
    const place = airAt(inAir)
    const scattering = place.seenRayleigh.mul(rayleigh).add(place.seenMie.mul(mie))
    const light = lightTransmittance(uniforms, transmittance, place.altitude, place.cosLight)
    return scattering.mul(light)
  }
}

/**
 * Light scattered once that a group of samples loses: its dark part, times the light at that part's centre.
 *
 * @param group - Its index in the stretch.
 */
function lostInGroup(
  { steps, darkAt, scatteredAt, jitter }: March,
  { from, width, groups, samples, isMapped }: Stretch,
  group: Float
): Vec4 {
  const dark = float(0).toVar()
  const sum = float(0).toVar()
  const perSample = width.div(groups.mul(samples)).toConst() as Float
  const start = from.add(group.div(groups).mul(width)).toConst()
  loop('look', int(samples), look => {
    const position = float(look).add(jitter).mul(perSample).add(start).toConst() as Float
    const here = darkAt(position, isMapped).toConst() as Float
    dark.addAssign(here)
    sum.addAssign(position.mul(here))
  })
  const lost = vec4(0).toVar()
  If(dark.greaterThan(0), () => {
    const centre = sum.div(dark).toConst() as Float
    const inAir = steps.distance(centre).toConst() as Float
    lost.assign(scatteredAt(inAir).mul(steps.slope(centre).mul(dark.mul(perSample))))
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
