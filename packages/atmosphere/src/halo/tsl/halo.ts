import { If } from 'three/tsl'
import type { Float, Vec3, Vec4 } from '../../tsl-types'

/** Halo around a bright source in two lobes, as shader nodes. */
export interface Halo {
  /** Power of the tight lobe: larger is tighter. */
  innerPower: Float
  /** Fraction of the source's light in it. */
  innerStrength: Float
  outerPower: Float
  outerStrength: Float
  /** Cosine of the angle from the source at which the halo ends. */
  cosMaxAngle: Float
}

/**
 * Adds a halo to radiance [1/sr].
 *
 * Each lobe is cosⁿ of the angle from the source, written as exp(−n |v − s|²/2), which keeps its digits
 * near the source; the factor (n + 1)/2π makes it integrate to its strength.
 *
 * @param light - Variable that is added to.
 * @param irradiance - Irradiance by the source.
 * @param direction - View direction, unit length.
 * @param sourceDirection - Direction to the source, same frame, unit length.
 * @param cosViewSource - Cosine of the angle between the two.
 */
export function addHalo(
  light: { addAssign(value: Vec4): unknown },
  halo: Halo,
  irradiance: Vec4,
  direction: Vec3,
  sourceDirection: Vec3,
  cosViewSource: Float
): void {
  If(cosViewSource.greaterThan(halo.cosMaxAngle), () => {
    const chord = direction.sub(sourceDirection).toConst()
    const square = chord.dot(chord).toConst()
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
