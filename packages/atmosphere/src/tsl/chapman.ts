import { If, float, vec2, vec3 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import type { Float, Vec2, Vec3 } from '../tsl-types'

/**
 * e^{z²} erfc(z) for z ≥ 0 as (1 + a z)/(1 + b z + c z²), within 1.2 %: it has value and slope at 0
 * and the limit z → ∞, which leave one number free; c makes it exact at 1.
 */
const C = 0.8597
const A = C / Math.sqrt(Math.PI)
const B = A + 2 / Math.sqrt(Math.PI)

const scaledErfc = (z: Vec2): Vec2 => z.mul(A).add(1).div(z.mul(C).add(B).mul(z).add(1))

/** d/w of a point on the middle of the absorber's layer along its horizon, (3/8)²: see {@link absorberColumn}. */
const WITHIN = 9 / 64

/**
 * Divisors and factors of an atmosphere that every point on a ray needs: made once, outside of loops.
 *
 * Molecules in layers are taken for a single one of as many: at 50 km of the standard atmosphere that is
 * 3.1 times their density; overhead of the ground they are as many.
 */
export interface ProfileConstants {
  /** 1/H of molecules and aerosols [1/m]. */
  slopes: Vec2
  /** 1/w, w half the width of the absorber's layer [1/m]. */
  absorberSlope: Float
  /** 2w/r_bottom. */
  absorberWidth: Float
  /** √(r_bottom/2H) for molecules and aerosols. */
  steepness: Vec2
  /** √(π r_bottom H/2), column along the horizon over density [m]. */
  horizon: Vec2
}

/** Makes {@link ProfileConstants}. */
export function profileConstants(uniforms: AtmosphereUniforms): ProfileConstants {
  const { bottomRadius, homogeneousHeight, mieScaleHeight, absorptionHalfWidth } = uniforms
  const heights = vec2(homogeneousHeight, mieScaleHeight).toConst() as Vec2
  const slopes = vec2(1).div(heights).toConst() as Vec2
  const steepness = slopes.mul(bottomRadius).mul(0.5).sqrt().toConst() as Vec2
  return {
    slopes,
    absorberSlope: absorptionHalfWidth.reciprocal().toConst(),
    absorberWidth: absorptionHalfWidth.mul(2).div(bottomRadius).toConst(),
    steepness,
    horizon: heights.mul(steepness).mul(Math.sqrt(Math.PI)).toConst()
  }
}

/** Densities at an altitude, as `densities` has them, and where in the absorber's layer that is. */
export interface Profile {
  density: Vec3
  /** y, −1 at the layer's lower edge, 0 in its middle. */
  inLayer: Float
}

/** Densities at an altitude h ≥ 0 [m], without divisions. */
export function profileAt(
  { absorptionAltitude }: AtmosphereUniforms,
  { slopes, absorberSlope }: ProfileConstants,
  altitude: Float
): Profile {
  const inLayer = altitude.sub(absorptionAltitude).mul(absorberSlope).toConst() as Float
  const air = slopes.mul(altitude).negate().exp()
  return {
    density: vec3(air, inLayer.abs().oneMinus().max(0)).toConst(),
    inLayer
  }
}

/**
 * Column of the absorber to space along a ray that does not descend: what is above over
 * √(μ² + 2d/r_bottom), where d is the height of its middle as the horizon weighs it.
 *
 * Exact overhead; on the horizon d is exact from the layer's middle up, and within 2 % below it.
 *
 * @param inLayer - y of the {@link Profile}.
 * @param square - μ².
 */
function absorberColumn(
  { absorptionHalfWidth }: AtmosphereUniforms,
  { absorberWidth }: ProfileConstants,
  inLayer: Float,
  square: Float
): Float {
  const y = inLayer.clamp(-1, 1).toConst()
  const above = y.mul(y.abs()).mul(0.5).sub(y).add(0.5)
  const below = inLayer.mul(-0.68).add(WITHIN).max(inLayer.add(0.18).negate())
  const d = below.max(inLayer.mul(-WITHIN).add(WITHIN)).max(1e-3)
  return above.mul(absorptionHalfWidth).mul(d.mul(absorberWidth).add(square).inverseSqrt())
}

/**
 * Columns of molecules, aerosols and absorber from a point to space, in closed form: lengths of way
 * through air of density 1 [m].
 *
 * With an exponential density that of a ray that ascends is n √(π r H/2) e^{z²} erfc z, z = μ √(r/2H);
 * one that descends to an altitude h_t has twice the horizontal one there less that backwards.
 * Molecules and aerosols are within 1.5 % of exponentials, air above `topRadius` included; the absorber is within 5 %
 * from below its layer, and within 30 % along the horizon from within it.
 *
 * @param altitude - h, in the air [m].
 * @param cosView - μ, not below the horizon.
 * @param profile - {@link profileAt} that altitude.
 * @see Chapman 1931; Schüler, "An approximation to the Chapman grazing-incidence function", GPU Pro 3.
 *   Twin: `opticalDepth` of cpu/transmittance.ts, by quadrature
 */
export function columnsToSpace(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  altitude: Float,
  cosView: Float,
  { density, inLayer }: Profile
): Vec3 {
  const { horizon, steepness } = constants
  const square = cosView.mul(cosView).toConst() as Float
  const air = horizon.mul(density.xy).mul(scaledErfc(steepness.mul(cosView.abs()).toConst()))
  const columns = vec3(air, absorberColumn(uniforms, constants, inLayer, square)).toVar()
  If(cosView.lessThan(0), () => {
    const radius = uniforms.bottomRadius.add(altitude)
    const drop = radius.mul(square).div(square.oneMinus().max(0).sqrt().add(1))
    const lowest = profileAt(uniforms, constants, altitude.sub(drop).max(0).toConst())
    const absorber = absorberColumn(uniforms, constants, lowest.inLayer, float(0))
    columns.assign(vec3(horizon.mul(lowest.density.xy), absorber).mul(2).sub(columns).max(0))
  })
  return columns
}
