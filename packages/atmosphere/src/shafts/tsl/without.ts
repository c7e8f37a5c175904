import { If } from 'three/tsl'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'
import type { Float, Vec4 } from '../../tsl-types'
import { SKY_DISTANCE, type LayerRay } from '../../view/SkyLayer'

/** Distance that stands for the sky; for the planet where it was not drawn it is {@link SKY_DISTANCE} [m]. */
export const FAR = 1e10

/** A medium less light that it loses, and no less than none, where shafts are on. */
export function withoutLost(
  { radiance, depth }: MediumSegment,
  strength: Float,
  lost: () => Vec4
): MediumSegment {
  const left = radiance.toVar()
  If(strength.greaterThan(0), () => {
    left.subAssign(lost().min(left))
  })
  return { radiance: left, depth }
}

/** Distance to what a ray meets: to the sky, or the planet, where nothing was drawn [m]. */
export const distanceOf = ({ distance, hitsGround }: Partial<LayerRay>): Float =>
  distance ?? hitsGround!.select(SKY_DISTANCE, FAR).toConst()
