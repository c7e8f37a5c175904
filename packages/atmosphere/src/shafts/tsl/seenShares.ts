import { log2, mix } from 'three/tsl'
import type { Bool, Float } from '../../tsl-types'
import type { ForegroundLayer } from '../../view/AirShadows'
import type { ShaftRay } from './shadowsAlong'
import { FAR } from './without'

/** Transmittance below which a foreground layer hides what is behind it. Greater: shafts end at thin clouds (*Below a broken deck*). */
const MIN_TRANSMITTANCE = 0.01

/** A foreground layer at a pixel, and its distance [m]. */
type Foreground = ReturnType<ForegroundLayer['seenAt']>

/** Parts of the light before and behind a distance [m] that a picture has. */
export interface SeenShares {
  readonly distance: Float
  readonly before: Float
  readonly behind: Float
}

/** Part of a pixel's light that a foreground covers from which on its distance counts [–]. */
export const MIN_COVER = 0.05

/** Difference of a foreground's transmittance from ½ below which its edge is soft. */
const SHARP = 0.48

/** True at the soft edge of a foreground. */
export const isSoft = ({ transmittance }: Pick<Foreground, 'transmittance'>): Bool =>
  transmittance.sub(0.5).abs().lessThan(SHARP) as Bool

/** log₂ of the greatest distance that is told from others where there is a foreground: farther than one sees the ground from low orbits. */
const FAR_OCTAVES = 19

/** log₂ of the distance to what is seen: between a foreground's and that of what is behind. */
export function octavesOf(
  distance: Float,
  front: { octaves: Float; transmittance: Float } | undefined
): Float {
  const octaves = log2(distance).toConst() as Float
  if (front === undefined) return octaves
  return mix(front.octaves, octaves.min(FAR_OCTAVES), front.transmittance).toConst() as Float
}

/** A ray as far as a picture has its light. */
export function seenBy(ray: ShaftRay, shares: SeenShares | undefined): ShaftRay {
  if (shares === undefined) return ray
  const { distance, before, behind } = shares
  const most = isHidden(shares).select(distance, FAR)
  return {
    ...ray,
    distance: ray.distance.min(most).toConst() as Float,
    seenFrom: from => from.lessThan(distance).select(before, behind)
  }
}

/** Parts of the light before and behind a foreground; behind it, shadows of materials (`isForward`) are dimmed with them. */
export function sharesOf({ distance, transmittance }: Foreground, isForward: Float): SeenShares {
  const before = transmittance.mul(isForward).oneMinus().toConst() as Float
  const behind = transmittance.mul(isForward.oneMinus()).toConst() as Float
  return { distance, before, behind }
}

/** True if nothing is seen behind a foreground. */
export const isHidden = ({ behind }: SeenShares): Bool =>
  behind.lessThanEqual(MIN_TRANSMITTANCE) as Bool
