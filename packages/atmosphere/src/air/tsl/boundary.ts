import { Fn } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** Layout of a `Fn` of floats. */
const layout = (name: string, ...inputs: string[]) => ({
  name,
  type: 'float' as const,
  inputs: inputs.map(input => ({ name: input, type: 'float' as const }))
})

/**
 * Distance along a ray, from inside the air to its top boundary.
 *
 * The far root of |p + d·v| = r_top: d = −rμ + √(r²μ² + (r_top − r)(r_top + r)), from altitudes, so
 * that nothing cancels in float32.
 *
 * @param altitude - Ray origin above the ground, in [0, thickness] [m].
 * @param cosView - μ, cosine between ray and local up, in [−1, 1].
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param thickness - Thickness of the air [m].
 * @returns d ≥ 0 [m].
 * @see Bruneton 2017, "Distance to the top atmosphere boundary". Twin: cpu/boundary.ts
 */
export const distanceToTop = /*#__PURE__*/ Fn(
  ([altitude, cosView, bottomRadius, thickness]: [Float, Float, Float, Float]) => {
    const radial = bottomRadius.add(altitude).mul(cosView).toConst('radial')
    const gap = thickness.sub(altitude).mul(bottomRadius.mul(2).add(thickness).add(altitude))
    return radial.mul(radial).add(gap).max(0).sqrt().sub(radial).max(0)
  },
  layout('distanceToTop', 'altitude', 'cosView', 'bottomRadius', 'thickness')
)

/**
 * r²μ² − (r − r_bottom)(r + r_bottom): the square of half the chord that a ray's line cuts from the
 * planet, negative if it passes above the ground [m²].
 *
 * @param altitude - Ray origin above the ground [m].
 * @param cosView - μ, in [−1, 1].
 * @param bottomRadius - Planet's centre to the ground [m].
 */
export const groundDiscriminant = /*#__PURE__*/ Fn(
  ([altitude, cosView, bottomRadius]: [Float, Float, Float]) => {
    const radial = bottomRadius.add(altitude).mul(cosView).toConst('radial')
    return radial.mul(radial).sub(altitude.mul(bottomRadius.mul(2).add(altitude)))
  },
  layout('groundDiscriminant', 'altitude', 'cosView', 'bottomRadius')
)

/**
 * Distance along a ray that meets the ground.
 *
 * @param altitude - Ray origin above the ground [m].
 * @param cosView - μ, in [−1, 0].
 * @param discriminant - {@link groundDiscriminant} of the same ray, ≥ 0 [m²].
 * @param bottomRadius - Planet's centre to the ground [m].
 * @returns d ≥ 0 [m].
 */
export const distanceToGround = /*#__PURE__*/ Fn(
  ([altitude, cosView, discriminant, bottomRadius]: [Float, Float, Float, Float]) => {
    // The near root as c / (−b + √D): the other form cancels close to the ground.
    const radial = bottomRadius.add(altitude).mul(cosView)
    const product = altitude.mul(bottomRadius.mul(2).add(altitude))
    return product.div(discriminant.max(0).sqrt().sub(radial).max(1e-3)).max(0)
  },
  layout('distanceToGround', 'altitude', 'cosView', 'discriminant', 'bottomRadius')
)

/**
 * Altitude of a point on a ray, without the cancellation of |p| − r_bottom.
 *
 * h' = h + (2 r μ t + t²)/(r' + r).
 *
 * @param altitude - Ray origin above the ground [m].
 * @param cosView - μ, in [−1, 1].
 * @param distance - t [m].
 * @param bottomRadius - Planet's centre to the ground [m].
 */
export const altitudeAlong = /*#__PURE__*/ Fn(
  ([altitude, cosView, distance, bottomRadius]: [Float, Float, Float, Float]) => {
    const radius = bottomRadius.add(altitude).toConst('radius')
    const rise = radius.mul(cosView).mul(2).add(distance).mul(distance).toConst('rise')
    return altitude.add(rise.div(radius.mul(radius).add(rise).max(0).sqrt().add(radius)))
  },
  layout('altitudeAlong', 'altitude', 'cosView', 'distance', 'bottomRadius')
)
