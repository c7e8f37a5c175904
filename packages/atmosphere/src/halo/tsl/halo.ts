import { If } from 'three/tsl'
import type { Float, Vec3, Vec4 } from '../../tsl-types'

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
 * Adds a halo to light [1/sr].
 *
 * Each lobe is cosⁿ of the angle from it, as exp(−n |v − s|²/2), which keeps its digits near the
 * middle; (n + 1)/2π makes it add up to its strength.
 *
 * @param light - A variable.
 * @param irradiance - By what is in its middle.
 * @param direction - Of view, unit length.
 * @param centre - Unit length, same frame.
 * @param cosCentre - Cosine of the angle between them.
 */
export function addHalo(
  light: { addAssign(value: Vec4): unknown },
  halo: Halo,
  irradiance: Vec4,
  direction: Vec3,
  centre: Vec3,
  cosCentre: Float
): void {
  If(cosCentre.greaterThan(halo.cosReach), () => {
    const apart = direction.sub(centre).toConst()
    const square = apart.dot(apart).toConst()
    const lobe = (power: Float, strength: Float): Float =>
      square
        .mul(power)
        .mul(-0.5)
        .exp()
        .mul(power.add(1).mul(strength))
        .mul(0.5 / Math.PI)
    const inner = lobe(halo.innerPower, halo.innerStrength)
    light.addAssign(irradiance.mul(inner.add(lobe(halo.outerPower, halo.outerStrength))))
  })
}
