import { If, float, int, vec2, vec4 } from 'three/tsl'
import { rayLimits } from '../../skyVolume/tsl/rayLimits'
import { enterAir } from '../../skyVolume/tsl/skyVolumeBake'
import { loop, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import type { ShadowedMedium } from '../../view/SkyLayer'
import type { ViewUniforms } from '../../view/ViewUniforms'
import { litRay } from './litRay'
import { lostDiffuse } from './lostDiffuse'
import { dimmedBy, middleOfDark } from './lostInMedia'
import { scatteredOnce } from './lostLight'
import { polarRay } from './polarMap'
import { shadowsAlong, type ShadowedAir, type ShaftRay } from './shadowsAlong'

/** Stretch of a view ray, by distances from the camera [m]. */
export interface Slice {
  readonly from: Float
  readonly to: Float
}

/**
 * Light that shadows keep from a slice of a view ray, for unit irradiance of the source [1/sr]: as `lostLight` has it, of
 * one group of samples.
 *
 * @param samples - Samples of the shadow.
 * @param jitter - Place of samples in their steps, in (0, 1).
 * @returns Light, and where the dark part begins and ends [m].
 */
export function lostInSlice(
  view: ViewUniforms,
  shadowedAir: ShadowedAir,
  shaftRay: ShaftRay,
  slice: Slice,
  samples: Float,
  jitter: Float
): { lost: Vec4; dark: Vec2 } {
  const { air, viewpoint } = view
  const { cosView, cosViewLight } = shaftRay
  const limits = rayLimits(viewpoint, cosView)
  const end = limits.start.add(limits.length).min(shaftRay.distance)
  const [from, to] = [slice.from, slice.to].map(
    distance => distance.clamp(limits.start, end).toConst() as Float
  )
  const length = to.sub(from).toConst()
  const lost = vec4(0).toVar()
  const dark = vec2(from, to).toVar()
  If(length.greaterThan(0), () => {
    const polar = polarRay(shadowedAir.frame, shaftRay.direction, cosViewLight)
    const mapped = shadowedAir.maximumRho.div(polar.sinViewLight).toConst()
    const { altitude, cosLight } = viewpoint
    const ray = enterAir(air, { altitude, cosView, cosLight, cosViewLight }, limits)
    const airAt = litRay(view, ray, limits, cosView, shadowedAir.denser())
    const { darkAt, missingAt } = shadowsAlong(view, shadowedAir, shaftRay, () => polar, jitter)
    const mediaTo = (distance: Float): readonly ShadowedMedium[] =>
      shadowedAir.mediaOn({ ...shaftRay, view, distance })
    const media = mediaTo(to)
    const past = dimmedBy(media, far => far)
    const sums = vec4(0).toVar()
    loop('sliceSample', int(samples), index => {
      const part = float(index).add(jitter).div(samples).toConst()
      const distance = from.add(length.mul(part)).toConst() as Float
      const here = darkAt(distance, distance.lessThan(mapped))
      sums.addAssign(vec4(1, part, part.mul(part), 0).mul(here))
    })
    const { x: sum } = sums
    If(sum.greaterThan(0), () => {
      const centre = sums.y.div(sum).toConst()
      const distance = from.add(length.mul(centre)).toConst() as Float
      const once = scatteredOnce(air, airAt, cosViewLight)(distance.sub(limits.start))
      const part = sum.div(samples).toConst()
      const darkLength = length.mul(part).toConst() as Float
      const half = middleOfDark(sum, jitter).mul(length).div(samples)
      const light = past(once, distance.sub(half), darkLength)
      lost.assign(light.mul(darkLength))
      // Of fog what the slice adds to the light before it.
      const before = media.length > 0 ? mediaTo(from) : []
      const fog = media.reduce<Vec4>((light, { singleScattered: added, transmittance }, i) => {
        const left = light.mul(transmittance)
        return added ? left.add(added.sub(before[i].singleScattered!).mul(part)) : left
      }, vec4(0))
      if (media.length > 0) lost.addAssign(fog)
      // As long as an even stretch of the same variance.
      const variance = sums.z.div(sum).sub(centre.mul(centre))
      const width = samples.mul(samples).mul(12).reciprocal()
      const aside = variance.add(width).max(0).mul(3).sqrt().toConst()
      const edges = vec2(centre.sub(aside).max(0), centre.add(aside).min(1))
      dark.assign(edges.mul(length).add(from))
    })
    if (missingAt === null) return
    const middle = from.add(to).mul(0.5).toConst() as Float
    const missing = missingAt(middle).toConst()
    const even = (distance: Float): Float => from.sub(limits.start).add(length.mul(distance))
    const steps = { distance: even, slope: () => length as Float, partAt: even }
    const diffuse = {
      steps,
      at: airAt,
      cosViewLight,
      samples: int(1),
      jitter: float(0.5),
      missingAt: () => past(missing, from, length)
    }
    lost.addAssign(lostDiffuse(air, diffuse))
    const before = media.length > 0 ? mediaTo(from) : []
    media.forEach(({ multiplyScattered: often }, i) =>
      lost.addAssign(often.sub(before[i].multiplyScattered).mul(missing))
    )
  })
  return { lost, dark }
}
