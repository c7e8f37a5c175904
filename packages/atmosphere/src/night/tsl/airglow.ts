import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** A luminous layer around a planet, as nodes: see `GlowLayer` of test/twins/airglow.ts. */
export interface GlowLayerNodes {
  /** Altitude of its middle [m]. */
  altitude: Float
  /** Standard deviation [m]. */
  width: Float
}

/**
 * F(q) = ∫₀^∞ exp(−(u² − q)²/2) du, within 0.7 %: what a Gaussian layer gives to a line whose nearest
 * point to the planet is q standard deviations below its middle.
 *
 * With R(q) = F(q) exp(min(q, 0)²/2), R(q) (q² + c)^¼ is a polynomial in q/√(q² + b), fitted to
 * quadrature for −5 ≤ q ≤ 80; at both ends it has F's own asymptote √(π/2q).
 */
function crossing(q: Float): Float {
  const coefficients = [1.44171, 1.14665, 0.26507, -1.70059, -1.54035, 0.72903, 0.91185]
  const square = q.mul(q).toConst()
  const t = q.div(square.add(3.75).sqrt()).toConst()
  const polynomial = coefficients.reduceRight<Float>(
    (sum, coefficient) => sum.mul(t).add(coefficient),
    float(0)
  )
  const below = q.clamp(-12, 0)
  return polynomial.div(square.add(3.2).sqrt().sqrt()).mul(below.mul(below).mul(-0.5).exp())
}

/** About Φ, the integral of the normal distribution. */
const normal = (x: Float): Float => x.mul(-1.702).clamp(-40, 40).exp().add(1).reciprocal()

/**
 * How many times brighter a layer is along a line than straight through, for each of the two places
 * where the line goes through it: on its way down to the point that is nearest to the planet, and up
 * from there. At the limb they are one, and share the light.
 *
 * @param altitude - Of the eye [m].
 * @param cosView - μ.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param distance - Where the line ends [m]; null for a line without end.
 * @see van Rhijn 1921 for lines that cross the layer steeply. Twin: test/twins/airglow.ts
 */
export function glowGains(
  layer: GlowLayerNodes,
  altitude: Float,
  cosView: Float,
  bottomRadius: Float,
  distance: Float | null
): { down: Float; up: Float } {
  const radius = bottomRadius.add(layer.altitude).toConst()
  // Along the line, from its point nearest to the planet.
  const start = bottomRadius.add(altitude).mul(cosView).toConst()
  const rise = layer.altitude.sub(altitude)
  const square = rise.mul(radius.add(bottomRadius).add(altitude)).add(start.mul(start)).toConst()
  const span = radius.mul(layer.width).mul(2).toConst()
  const gain = radius
    .div(layer.width)
    .div(Math.PI)
    .sqrt()
    .mul(crossing(square.div(span)))
    .toConst()
  const half = square.max(0).sqrt().toConst()
  // Standard deviation of each crossing along the line.
  const spread = span.div(half.max(span.sqrt()).mul(2)).toConst()
  const part = (at: Float): Float => {
    const ahead = normal(at.sub(start).div(spread))
    if (distance === null) return ahead
    return ahead.sub(normal(at.sub(start).sub(distance).div(spread))).max(0)
  }
  return {
    down: gain.mul(part(half.negate())),
    up: gain.mul(part(half))
  }
}

/**
 * How many times brighter a layer far above the eye is along a line than straight through: r/√(r² − b²),
 * b the line's distance from the planet's centre, which does not cross the ground.
 *
 * @param altitude - Of the eye, ten standard deviations below the layer or more [m].
 * @param cosView - μ.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @see van Rhijn 1921. Twin: test/twins/airglow.ts
 */
export function overheadGain(
  layer: GlowLayerNodes,
  altitude: Float,
  cosView: Float,
  bottomRadius: Float
): Float {
  const radius = bottomRadius.add(layer.altitude)
  const eye = bottomRadius.add(altitude).toConst()
  const start = eye.mul(cosView).toConst()
  const square = layer.altitude.sub(altitude).mul(radius.add(eye)).add(start.mul(start))
  return radius.mul(square.max(1).inverseSqrt())
}
