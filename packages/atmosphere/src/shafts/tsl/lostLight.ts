import { If, float, int, vec2, vec4 } from 'three/tsl'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import type { Air } from '../../scattering/tsl/ray'
import { rayLimits } from '../../skyVolume/tsl/rayLimits'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'
import { lightTransmittance } from '../../transmittance/tsl/transmittance'
import { loop, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import { SKY_DISTANCE } from '../../view/SkyLayer'
import type { ViewUniforms } from '../../view/ViewUniforms'
import { distanceToLight } from './distanceToLight'
import { litRay, type LitPoint } from './litRay'
import { lostDiffuse } from './lostDiffuse'
import { dimmedBy, lostInMedia, middleOfDark } from './lostInMedia'
import { polarRay } from './polarMap'
import { shadowsAlong, shadowsBeside, type ShadowedAir, type ShaftRay } from './shadowsAlong'
import { warpedSteps, type WarpedSteps } from './warpedSteps'

/** Number of samples on a ray. */
export interface ShaftSteps {
  /** Places at which the lit air is evaluated, if they are in shadow. */
  readonly groups: Float
  /** Samples of the shadow for each. */
  readonly samples: Float
  /** Samples beyond the map in each group. */
  readonly beyond: Float
  /** Samples in each medium, such as fog. Fewer than 8: grain before dark fog (`'low'` quality, *Towers in haze*). */
  readonly inFog: Float
}

/** Places at which diffuse light is evaluated, over groups, and the fewest: it changes slowly, and two pixels that touch share theirs. Fewer: stripes along silhouettes under clouds (*cirrus* under a low sun). */
const DIFFUSE_PART = 0.5
const LEAST_DIFFUSE = 2

/** Stretch of a ray that is marched in groups of samples, whatever its length. */
interface Stretch {
  /** Light of the ray before it, and in it, as parts of all. */
  readonly from: Float
  readonly width: Float
  /** Number of groups, and of samples in each. */
  readonly groups: Float
  readonly samples: Float
  /** True where the map has shadows. */
  readonly isMapped: boolean
}

/** March along a view ray. */
interface March {
  readonly steps: WarpedSteps
  /** Part of a place's light that the picture loses, by position among the steps. */
  readonly darkAt: (position: Float, isMapped: boolean) => Float
  /** Light scattered once at a distance in the air, if nothing casts shadows [1/(m sr)]. */
  readonly scatteredAt: (inAir: Float) => Vec4
  /** Light of a stretch of the steps, as media such as fog leave it. */
  readonly past: (light: Vec4, from: Float, width: Float) => Vec4
  readonly jitter: Float
}

/**
 * Single scattering that shadows keep from a view ray, for unit irradiance of the source [1/sr]:
 * ∫ σ_s p(ν) T_light T_view (1 − V) over the ray, where V is the part of the light that occluders let through. Besides
 * {@link lostDiffuse}, if there are occluders that dim diffuse light, and {@link lostInMedia} such as fog.
 *
 * The ray is cut into groups of samples, spaced so that each holds about the same light. In each the samples
 * give the dark part and its centre; there the light is evaluated once, which is exact where it varies linearly.
 * Where there are shadows beyond the map, the ray goes on there with samples of its own.
 *
 * @param jitter - Place of samples in their steps, in (0, 1).
 */
export function lostLight(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  shaftRay: ShaftRay,
  { groups, samples, beyond, inFog }: ShaftSteps,
  jitter: Float
): Vec4 {
  const { air, viewpoint } = view
  const { maximumRho, shadows } = shadowedAir
  const { cosView, cosViewLight, distance, start } = shaftRay
  const limits = rayLimits(viewpoint, cosView)
  const polar = polarRay(shadowedAir.frame, shaftRay.direction, cosViewLight)
  const widest = start ? maximumRho.add(start.length()) : maximumRho
  const mapped = widest.div(polar.sinViewLight).toConst() as Float
  const isMappedOnly = shadows.length === 0
  const seen = limits.start.add(limits.length).min(distance)
  const end = isMappedOnly ? seen.min(mapped) : seen
  const length = end.sub(limits.start).toConst() as Float
  const lost = vec4(0).toVar()
  If(length.greaterThan(0), () => {
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
    const steps = warpedSteps(air.uniforms, ray, length)
    const isSky = distance.greaterThanEqual(SKY_DISTANCE)
    const denser = shadowedAir.denser()
    const airAt = litRay(view, ray, limits, cosView, denser && isSky.select(1, denser))
    const { darkAt, missingAt } = start
      ? shadowsBeside(view, shadowedAir, shaftRay, jitter)
      : shadowsAlong(view, shadowedAir, shaftRay, () => polar, jitter)
    const fromEye = (inAir: Float): Float => inAir.add(limits.start).toConst()
    const media = shadowedAir.mediaOn({ ...shaftRay, view })
    const past = dimmedBy(media, far => steps.partAt(far.sub(limits.start)))
    const march: March = {
      steps,
      darkAt: (position, isMapped) => darkAt(fromEye(steps.distance(position)), isMapped),
      scatteredAt: scatteredOnce(air, airAt, cosViewLight),
      past,
      jitter
    }
    if (media.length > 0) {
      const shadows = { darkAt: (far: Float) => darkAt(far, far.lessThan(mapped)), missingAt }
      lost.addAssign(lostInMedia(media, shadows, { count: inFog, jitter }))
    }
    const marchStretch = (name: string, stretch: Stretch): void => {
      const perGroup = stretch.width.div(stretch.groups).toConst()
      loop(name, int(stretch.groups), group => {
        lost.addAssign(lostInGroup(march, stretch, perGroup.mul(float(group)).add(stretch.from)))
      })
    }
    const partAt = (from: Float): Float =>
      steps.partAt(from.sub(limits.start).clamp(0, length)).toConst()
    const first = partAt(distanceToLight(viewpoint, cosView, cosViewLight))
    const lit = first.oneMinus().toConst() as Float
    if (isMappedOnly) {
      marchStretch('group', { from: first, width: lit, groups, samples, isMapped: true })
      return
    }
    const near = partAt(mapped).max(first).toConst() as Float
    // Each has groups by its light, and as many samples whatever that is.
    const part = (from: Float, width: Float, most: Float, isMapped: boolean): Stretch => {
      const some = groups
        .mul(width.div(lit.max(1e-6)))
        .ceil()
        .toConst() as Float
      const each = groups.mul(most).div(some.max(1)).ceil().toConst() as Float
      return { from, width, groups: some, samples: each, isMapped }
    }
    marchStretch('near', part(first, near.sub(first).toConst(), samples, true))
    marchStretch('far', part(near, near.oneMinus().toConst(), beyond, false))
    if (missingAt === null) return
    const places = int(groups.mul(DIFFUSE_PART).max(LEAST_DIFFUSE))
    const diffuse = {
      steps,
      at: airAt,
      cosViewLight,
      samples: places,
      jitter: jitter.lessThan(0.5).select(0.25, 0.75) as Float,
      missingAt: (inAir: Float, from: Float, width: Float) =>
        past(missingAt(fromEye(inAir)), from, width)
    }
    lost.addAssign(lostDiffuse(air, diffuse))
  })
  return lost
}

/** Light scattered once that a ray gains at a distance in the air, for unit irradiance [1/(m sr)]. */
export function scatteredOnce(
  { uniforms, transmittance }: Air,
  airAt: (inAir: Float) => LitPoint,
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
 * @param start - Light of the ray before it, as a part of all.
 */
function lostInGroup(
  { steps, darkAt, scatteredAt, past, jitter }: March,
  { width, groups, samples, isMapped }: Stretch,
  start: Float
): Vec4 {
  const dark = float(0).toVar()
  const sum = float(0).toVar()
  const perSample = width.div(groups.mul(samples)).toConst() as Float
  loop('groupSample', int(samples), index => {
    const position = float(index).add(jitter).mul(perSample).add(start).toConst() as Float
    const here = darkAt(position, isMapped).toConst() as Float
    dark.addAssign(here)
    sum.addAssign(position.mul(here))
  })
  const lost = vec4(0).toVar()
  If(dark.greaterThan(0), () => {
    const centre = sum.div(dark).toConst() as Float
    const inAir = steps.distance(centre).toConst() as Float
    const darkWidth = dark.mul(perSample).toConst() as Float
    const from = centre.sub(middleOfDark(dark, jitter).mul(perSample))
    const light = past(scatteredAt(inAir), from, darkWidth)
    lost.assign(light.mul(steps.slope(centre).mul(darkWidth)))
  })
  return lost
}

/**
 * Place of a pixel's samples in their steps: 1/8, 5/8, 7/8 or 3/8, of which any four pixels that touch have all, and any two
 * side by side or one above the other have one of the first half and one of the second.
 */
export const staggered = (pixel: Vec2): Float =>
  pixel.mod(2).dot(vec2(0.5, 0.75)).add(0.125).fract().toConst()
