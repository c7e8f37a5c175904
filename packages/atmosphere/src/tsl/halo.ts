import { If, float } from 'three/tsl'
import type { Float, Vec3 } from '../tsl-types'

/** Lobes of light that an eye or a lens spreads around something bright. */
export interface Halo {
  /** Power of the tight lobe: the larger, the tighter. */
  innerPower: Float
  /** Part of the light that goes into it. */
  innerStrength: Float
  outerPower: Float
  outerStrength: Float
  /** Cosine of the angle from its middle where it ends. */
  cosReach: Float
}

/**
 * Radiance of a halo, for unit irradiance by what is in its middle [1/sr].
 *
 * Each lobe is cosⁿ of the angle from it, as exp(−n |v − s|²/2), which keeps its digits near the
 * middle; (n + 1)/2π makes it add up to its strength.
 *
 * @param direction - Of view, unit length.
 * @param centre - Unit length, same frame.
 * @param cosCentre - Cosine of the angle between them.
 */
export function haloRadiance(
  halo: Halo,
  direction: Vec3,
  centre: Vec3,
  cosCentre = direction.dot(centre) as Float
): Float {
  const radiance = float(0).toVar()
  If(cosCentre.greaterThan(halo.cosReach), () => {
    const apart = direction.sub(centre).toConst()
    const square = apart.dot(apart).toConst()
    const lobe = (power: Float, strength: Float): Float =>
      square
        .mul(power)
        .mul(-0.5)
        .exp()
        .mul(power.add(1).mul(strength))
        .div(2 * Math.PI)
    radiance.assign(lobe(halo.innerPower, halo.innerStrength))
    radiance.addAssign(lobe(halo.outerPower, halo.outerStrength))
  })
  return radiance
}
