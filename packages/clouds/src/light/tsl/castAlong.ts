import type { Atmosphere, ShadowedShafts } from '@welkin/atmosphere'
import type { Camera } from 'three'
import { If, float } from 'three/tsl'
import type { Float, Vec3 } from '../../tsl-types'
import type { ShadingContext } from './shadingContext'

/** Clouds that take light past what casts shadows into their light shafts. */
export interface ShadedClouds {
  readonly atmosphere: Atmosphere
  readonly camera: Camera
  /** Light shafts that have the clouds' shadows. */
  readonly castsInto: ReadonlySet<ShadowedShafts>
}

/** Light shafts of the clouds' own camera. */
export const ownShafts = ({ camera, castsInto }: ShadedClouds): ShadowedShafts[] =>
  [...castsInto].filter(shafts => shafts.camera === camera)

/**
 * Part of the light that arrives at places of a view ray past what casts into the clouds' light shafts, but for the clouds
 * themselves: `ShadingContext.castAt`.
 *
 * @param jitter - Noise in (0, 1).
 */
export function castAlong(
  clouds: ShadedClouds,
  direction: Vec3,
  jitter: Float
): ShadingContext['castAt'] {
  const lights = ownShafts(clouds).map(shafts => ({
    isSun: shafts.source === clouds.atmosphere.sun,
    litAt: shafts.litAlong({ direction, jitter, receiver: clouds })
  }))
  if (lights.length === 0) return undefined
  return (distance, isMoonlit) => {
    const lit = float(1).toVar()
    for (const { isSun, litAt } of lights) {
      If(isSun ? isMoonlit.not() : isMoonlit, () => {
        lit.mulAssign(litAt(distance))
      })
    }
    return lit
  }
}
