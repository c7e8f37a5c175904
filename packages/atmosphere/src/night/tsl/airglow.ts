import { float } from 'three/tsl'
import type { Float } from '../../tsl-types'

/** Luminous layer around a planet, a Gaussian in altitude, as shader nodes. */
export interface AirglowLayerNodes {
  /** Altitude of the layer's middle [m]. */
  altitude: Float
  /** Standard deviation [m]. */
  width: Float
}

/** Standard deviation of what a pixel sees at once, over its diagonal: half of its side. */
const PIXEL_SIGMA = 0.35

/**
 * Layer as wide as a pixel sees it: from far away its limb is thinner than a pixel, and would be a line of dots.
 *
 * @param altitude - Altitude of the camera [m].
 * @param cosView - μ.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param pixel - Angle of the pixel's diagonal [rad].
 */
export function layerInPixel(
  layer: AirglowLayerNodes,
  altitude: Float,
  cosView: Float,
  bottomRadius: Float,
  pixel: Float
): AirglowLayerNodes {
  // At the ray's lowest point, from where it goes along the layer.
  const distance = bottomRadius.add(altitude).mul(cosView).min(0)
  const blur = distance.mul(pixel).mul(PIXEL_SIGMA).toConst()
  const width = layer.width.mul(layer.width).add(blur.mul(blur)).sqrt().toConst()
  return { altitude: layer.altitude, width }
}

/**
 * Light of a Gaussian layer along half of a line whose lowest point is q standard deviations below the
 * layer's middle: F(q) = ∫₀^∞ exp(−(u² − q)²/2) du, within 0.7 %.
 *
 * With R(q) = F(q) exp(min(q, 0)²/2), R(q) (q² + c)^¼ is a polynomial in q/√(q² + b), fitted to
 * quadrature for −5 ≤ q ≤ 80; at both ends it has F's own asymptote √(π/2q).
 */
function gaussianLayerIntegral(q: Float): Float {
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

/** Φ, the cumulative normal distribution, approximated by a logistic function. */
const normalCDF = (x: Float): Float => x.mul(-1.702).clamp(-40, 40).exp().add(1).reciprocal()

/**
 * Van Rhijn factors of a view ray: brightness of the layer along the ray over that seen perpendicularly,
 * for the crossing on the way down to the ray's lowest point and for the one on the way up. At the limb the
 * two crossings merge and share the light.
 *
 * @param altitude - Altitude of the camera [m].
 * @param cosView - μ.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @param distance - Length of the ray [m]; null for one without end.
 * @see Leinert et al. 1998, "The 1997 reference of diffuse night sky brightness", §6, after van Rhijn 1921, for rays
 *   that cross the layer steeply. Twin: test/twins/night/airglow.ts
 */
export function vanRhijnFactors(
  layer: AirglowLayerNodes,
  altitude: Float,
  cosView: Float,
  bottomRadius: Float,
  distance: Float | null
): { down: Float; up: Float } {
  const radius = bottomRadius.add(layer.altitude).toConst()
  // Distance of the camera along the ray from the ray's lowest point.
  const start = bottomRadius.add(altitude).mul(cosView).toConst()
  const rise = layer.altitude.sub(altitude)
  const square = rise.mul(radius.add(bottomRadius).add(altitude)).add(start.mul(start)).toConst()
  const span = radius.mul(layer.width).mul(2).toConst()
  const factor = radius
    .div(layer.width)
    .div(Math.PI)
    .sqrt()
    .mul(gaussianLayerIntegral(square.div(span)))
    .toConst()
  const half = square.max(0).sqrt().toConst()
  // Standard deviation of each crossing along the ray.
  const sigma = span.div(half.max(span.sqrt()).mul(2)).toConst()
  const fractionAt = (at: Float): Float => {
    const ahead = normalCDF(at.sub(start).div(sigma))
    if (distance === null) return ahead
    return ahead.sub(normalCDF(at.sub(start).sub(distance).div(sigma))).max(0)
  }
  return {
    down: factor.mul(fractionAt(half.negate())),
    up: factor.mul(fractionAt(half))
  }
}

/**
 * Van Rhijn factor of a layer far above the camera, taken for a thin shell: r/√(r² − b²), with b the
 * distance of the view ray from the planet's centre. The ray must not hit the ground.
 *
 * @param altitude - Altitude of the camera, at least ten standard deviations below the layer [m].
 * @param cosView - μ.
 * @param bottomRadius - Planet's centre to the ground [m].
 * @see van Rhijn 1921, as for {@link vanRhijnFactors}. Twin: test/twins/night/airglow.ts
 */
export function thinLayerVanRhijnFactor(
  layer: AirglowLayerNodes,
  altitude: Float,
  cosView: Float,
  bottomRadius: Float
): Float {
  const radius = bottomRadius.add(layer.altitude)
  const cameraRadius = bottomRadius.add(altitude).toConst()
  const start = cameraRadius.mul(cosView).toConst()
  const square = layer.altitude.sub(altitude).mul(radius.add(cameraRadius)).add(start.mul(start))
  return radius.mul(square.max(1).inverseSqrt())
}
