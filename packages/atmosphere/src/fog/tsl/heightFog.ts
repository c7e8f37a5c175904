import type { Bool, Float } from '../../tsl-types'
import { erfcx } from './erfcx'

/** Fog with a density that falls off exponentially with altitude, as shader nodes. */
export interface FogLayerNodes {
  /** Extinction at the base [1/m]. */
  density: Float
  /** Altitude over which the density falls to 1/e [m]. */
  falloff: Float
}

/** Range of exponents that float32 holds, with room for a chord's length. */
const MAX_EXPONENT = 60
const MIN_EXPONENT = -30

/**
 * Air mass of an exponential layer: column along an outward ray over that along the vertical.
 *
 * @param scale - Distance to the planet's centre, in falloff heights.
 * @param cosView - |μ|, against the zenith.
 * @see Fitzmaurice 1964, "Simplification of the Chapman function for atmospheric attenuation", Applied
 *   Optics 3, p. 640
 */
export function airMass(scale: Float, cosView: Float): Float {
  const half = scale.mul(0.5).sqrt().toConst()
  return half.mul(Math.sqrt(Math.PI)).mul(erfcx(half.mul(cosView)))
}

/** Fog along a segment of a ray. */
export interface FogDepth {
  /** Optical depth. */
  depth: Float
  /** Altitude of the start above the base, in falloff heights. */
  start: Float
  /** Slope of the ray into the fog, in falloff heights per metre; negative if it rises. */
  fall: Float
}

/**
 * Optical depth of fog along a segment, in closed form.
 *
 * It is the difference of the depths from both ends outwards, σH e^{−y} Ch. A ray that sinks first and then
 * rises is split at its lowest point. Density along a ray is least at an end: that bounds the result where
 * the difference cancels.
 *
 * @param height - Height of the ray's start above the fog's base [m].
 * @param radius - Planet's centre to the ray's start [m].
 * @param cosView - μ at the start.
 * @param distance - Length of the ray [m].
 * @see Twin: test/twins/fog/heightFog.ts
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
  const outwardThere = there.mul(airMass(radiusThere.div(falloff), cosThere.abs())).toConst()

  const sinks = cosView.lessThan(0).toConst()
  const passesNearest = sinks.and(cosThere.greaterThan(0)).toConst() as Bool
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
  const between = passesNearest.select(
    chord.sub(outward).sub(outwardThere),
    sinks.select(outwardThere.sub(outward), outward.sub(outwardThere))
  )
  const least = here.min(there).mul(distance)
  const most = passesNearest.select(lowest, here.max(there)).mul(distance)
  const depth = between.mul(falloff).clamp(least, most).mul(density)
  const sinking = passesNearest
    .select(drop.div(along.min(-1)), gain.div(distance.max(1e-3)))
    .negate()
  return {
    depth: depth.toConst(),
    start: height.div(falloff).toConst(),
    fall: sinks.select(sinking, cosView.negate()).div(falloff).toConst()
  }
}

/**
 * Mean radiance of light that fog has scattered more than once, for unit irradiance [1/sr].
 *
 * Eddington's solution of a plane layer without absorption over black ground, in optical depths scaled by
 * 1 − g (similarity).
 *
 * @param above - Vertical optical depth above the point.
 * @param total - Vertical optical depth of the layer.
 * @param cosLight - Cosine of the light's zenith angle that gives the slant depth, > 0.
 * @see Liou 2002, An Introduction to Atmospheric Radiation, 2nd ed., §6.5 (Eddington's approximation), after
 *   Shettle & Weinman 1970, J. Atmos. Sci. 27, 1048. Twin: test/twins/fog/heightFog.ts
 */
export function multipleScattering(above: Float, total: Float, cosLight: Float): Float {
  const top = cosLight.mul(3).add(2).toConst()
  const bottom = cosLight.mul(-3).add(2).mul(total.div(cosLight).negate().exp())
  const direct = cosLight.mul(3).mul(above.div(cosLight).negate().exp())
  const slope = top.add(bottom).div(total.add(4 / 3))
  return top
    .sub(direct)
    .sub(slope.mul(above.add(2 / 3)))
    .mul(cosLight)
    .mul(1 / (4 * Math.PI))
    .max(0)
}

/** Henyey–Greenstein phase function, of droplets [1/sr]. @see Henyey & Greenstein 1941, eq. 2 */
export function henyeyGreenstein(cosViewLight: Float, asymmetry: Float): Float {
  const square = asymmetry.mul(asymmetry).toConst()
  const chord = square.add(1).sub(asymmetry.mul(cosViewLight).mul(2)).max(1e-4).toConst()
  return square
    .oneMinus()
    .div(chord.mul(chord.sqrt()))
    .mul(1 / (4 * Math.PI))
}
