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
  const lights = ownShafts(clouds)
  if (lights.length === 0) return undefined
  const ray = { direction, jitter, receiver: clouds }
  return (distance, isMoonlit) => {
    const lit = float(1).toVar()
    for (const shafts of lights) {
      If(shafts.source === clouds.atmosphere.sun ? isMoonlit.not() : isMoonlit, () => {
        lit.mulAssign(shafts.litAt(ray, distance))
      })
    }
    return lit
  }
}
