import { float } from 'three/tsl'
import { ERFCX_COEFFICIENTS, ERFCX_SCALE } from '../cpu/heightFog'
import type { Bool, Float } from '../../tsl-types'

/** Fog whose density falls off exponentially with altitude, as nodes: see `FogLayer` of cpu/heightFog.ts. */
export interface FogLayerNodes {
  /** Extinction at the base [1/m]. */
  density: Float
  /** Altitude over which it falls to 1/e [m]. */
  falloff: Float
}

/** Exponents that float32 still holds, with room for a chord's length. */
const MAX_EXPONENT = 60
const MIN_EXPONENT = -30

/** e^{x²} erfc x for x ≥ 0, within 7e-6: a polynomial in 1/(1 + cx), exact at 0, with its slope, and at ∞. */
export function erfcx(x: Float): Float {
  const t = x.mul(ERFCX_SCALE).add(1).reciprocal().toConst()
  const polynomial = ERFCX_COEFFICIENTS.reduceRight<Float>(
    (sum, coefficient) => sum.mul(t).add(coefficient),
    float(0)
  )
  return polynomial.mul(t)
}

/**
 * Air mass of an exponential layer, in falloff heights: what a ray out of the planet crosses, over what
 * a vertical one does.
 *
 * @param scale - Distance to the planet's centre, in falloff heights.
 * @param cosView - |μ|, against the zenith.
 * @see Fitzmaurice 1964, "Simplification of the Chapman function for atmospheric attenuation"
 */
export function airMass(scale: Float, cosView: Float): Float {
  const half = scale.mul(0.5).sqrt().toConst()
  return half.mul(Math.sqrt(Math.PI)).mul(erfcx(half.mul(cosView)))
}

/** Fog along a straight way. */
export interface FogDepth {
  /** Optical depth. */
  depth: Float
  /** Altitude of the start above the base, in falloff heights. */
  start: Float
  /** How fast the ray sinks on its way into the fog, in falloff heights per metre; negative if it rises. */
  fall: Float
}

/**
 * Optical depth of fog between two points of a ray, in closed form.
 *
 * Each end has the fog of the ray from there outwards, σH e^{−y} Ch: their difference is what lies
 * between. A ray that sinks first and then rises has its lowest point, and the fog of both halves.
 * Density along a ray is least at an end: that bounds the result, where the difference cancels.
 *
 * @param height - Of the ray's start above the fog's base [m].
 * @param radius - Planet's centre to there [m].
 * @param cosView - μ at the start.
 * @param distance - Length of the ray [m].
 * @see Twin: cpu/heightFog.ts
 */
export function fogDepth(
  { density, falloff }: FogLayerNodes,
  height: Float,
  radius: Float,
  cosView: Float,
  distance: Float
): FogDepth {
  const exponent = (above: Float): Float =>
    above.div(falloff).clamp(MIN_EXPONENT, MAX_EXPONENT).toConst()
  const along = radius.mul(cosView).toConst()
  const rise = along.mul(2).add(distance).mul(distance).toConst()
  const radiusThere = radius.mul(radius).add(rise).max(1).sqrt().toConst()
  const cosThere = along.add(distance).div(radiusThere).clamp(-1, 1).toConst() as Float
  const gain = rise.div(radiusThere.add(radius)).toConst()
  const here = exponent(height).negate().exp().toConst()
  const there = exponent(height.add(gain)).negate().exp().toConst()
  const outward = here.mul(airMass(radius.div(falloff), cosView.abs())).toConst()
  const beyond = there.mul(airMass(radiusThere.div(falloff), cosThere.abs())).toConst()

  const sinks = cosView.lessThan(0).toConst()
  const turns = sinks.and(cosThere.greaterThan(0)).toConst() as Bool
  const lowestRadius = radius.mul(cosView.mul(cosView).oneMinus().max(0).sqrt()).toConst()
  const drop = along.mul(along).div(lowestRadius.add(radius)).toConst()
  const lowest = exponent(height.sub(drop)).negate().exp().toConst()
  const chord = lowest
    .mul(
      lowestRadius
        .div(falloff)
        .mul(Math.PI / 2)
        .sqrt()
    )
    .mul(2)
  const between = turns.select(
    chord.sub(outward).sub(beyond),
    sinks.select(beyond.sub(outward), outward.sub(beyond))
  )
  const least = here.min(there).mul(distance)
  const most = turns.select(lowest, here.max(there)).mul(distance)
  const depth = between.mul(falloff).clamp(least, most).mul(density)
  const sinking = turns.select(drop.div(along.min(-1)), gain.div(distance.max(1e-3))).negate()
  return {
    depth: depth.toConst(),
    start: height.div(falloff).toConst(),
    fall: sinks.select(sinking, cosView.negate()).div(falloff).toConst()
  }
}

/**
 * Mean radiance of sunlight that fog has scattered more than once, for unit irradiance [1/sr].
 *
 * Eddington's solution of a plane layer that absorbs nothing, over black ground, in depths that
 * similarity has scaled by 1 − g.
 *
 * @param above - Vertical depth above the point.
 * @param whole - Vertical depth of the layer.
 * @param cosSun - Cosine of the sun's zenith angle that gives the slant depth, > 0.
 * @see Shettle & Weinman 1970, "The transfer of solar irradiance through inhomogeneous turbid
 *   atmospheres evaluated by Eddington's approximation". Twin: cpu/heightFog.ts
 */
export function multipleScattering(above: Float, whole: Float, cosSun: Float): Float {
  const top = cosSun.mul(3).add(2).toConst()
  const bottom = cosSun.mul(-3).add(2).mul(whole.div(cosSun).negate().exp())
  const direct = cosSun.mul(3).mul(above.div(cosSun).negate().exp())
  const slope = top.add(bottom).div(whole.add(4 / 3))
  return top
    .sub(direct)
    .sub(slope.mul(above.add(2 / 3)))
    .mul(cosSun)
    .mul(1 / (4 * Math.PI))
    .max(0)
}

/** Phase function of droplets: Henyey & Greenstein 1941 [1/sr]. */
export function henyeyGreenstein(cosViewSun: Float, asymmetry: Float): Float {
  const square = asymmetry.mul(asymmetry).toConst()
  const chord = square.add(1).sub(asymmetry.mul(cosViewSun).mul(2)).max(1e-4).toConst()
  return square
    .oneMinus()
    .div(chord.mul(chord.sqrt()))
    .mul(1 / (4 * Math.PI))
}
