import { Vector2 } from 'three'
import { If, float, uniform, vec3 } from 'three/tsl'
import type { AtmosphereParameters } from '../../parameters/AtmosphereParameters'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { homogeneousHeight } from '../../air/cpu/medium'
import type { Float, Vec2, Vec3 } from '../../tsl-types'

/**
 * Coefficients of e^{z²} erfc(z) ≈ (1 + a z)/(1 + b z + c z²) for z ≥ 0, within 1.2 %: exact in value and
 * slope at 0, in the limit z → ∞, and at z = 1.
 */
const C = 0.8597
const A = C / Math.sqrt(Math.PI)
const B = A + 2 / Math.sqrt(Math.PI)

function scaledErfc(z: Vec2): Vec2 {
  const divisor = z.mul(C).add(B).mul(z).add(1).toConst() as Vec2
  // One division for both.
  return z.mul(A).add(1).mul(divisor.yx).mul(divisor.x.mul(divisor.y).reciprocal())
}

/** d/w of {@link absorberLength} for a horizontal ray in the middle of the absorber's layer, (3/8)². */
const HORIZON_WEIGHT = 9 / 64

/**
 * Constants of an atmosphere's density profiles, shared by all points of a ray.
 *
 * Several layers of molecules become one exponential with the same vertical column: at 50 km of the
 * standard atmosphere it has 3.1 times their density.
 */
export interface ProfileConstants {
  /** log₂ e/H of molecules and aerosols [1/m]. */
  slopes: Vec2
  /** 1/w, w half the width of the absorber's layer [1/m]. */
  absorberSlope: Float
  /** 2w/r_bottom. */
  absorberWidth: Float
  /** √(r_bottom/2H) for molecules and aerosols. */
  steepness: Vec2
  /** √(π r_bottom H/2), column along the horizon over density [m]. */
  horizon: Vec2
  /**
   * Growth of the logarithm of a march's steps with altitude [1/m]: slower than density falls, and slower
   * still in thick air, where the visible light comes from high up.
   */
  growth: Float
}

/** Growth of steps in thin air over that of density. Larger coarsens steps in the limb's upper air. Story: Shell, SingleScattering. */
const GROWTH = 0.35
/** Optical depth to the zenith that halves {@link GROWTH}. */
const THICK_DEPTH = 10

/** {@link ProfileConstants} as uniforms. */
export class ProfileUniforms implements ProfileConstants {
  readonly slopes = uniform(new Vector2())
  readonly absorberSlope = uniform(0)
  readonly absorberWidth = uniform(0)
  readonly steepness = uniform(new Vector2())
  readonly horizon = uniform(new Vector2())
  readonly growth = uniform(0)

  update(parameters: AtmosphereParameters): void {
    const { bottomRadius, mieScaleHeight, absorptionHalfWidth } = parameters
    const molecularHeight = homogeneousHeight(parameters)
    const heights = [molecularHeight, mieScaleHeight] as const
    this.slopes.value.set(...map(heights, height => Math.LOG2E / height))
    this.steepness.value.set(...map(heights, height => Math.sqrt(bottomRadius / (2 * height))))
    this.horizon.value.set(
      ...map(heights, height => Math.sqrt((Math.PI * bottomRadius * height) / 2))
    )
    const depths = parameters.rayleighScattering.map(
      (molecules, i) =>
        molecules * molecularHeight +
        parameters.mieExtinction[i] * mieScaleHeight +
        parameters.absorptionExtinction[i] * absorptionHalfWidth
    )
    this.growth.value = GROWTH / (1 + Math.max(...depths) / THICK_DEPTH) / Math.max(...heights)
    this.absorberSlope.value = 1 / absorptionHalfWidth
    this.absorberWidth.value = (2 * absorptionHalfWidth) / bottomRadius
  }
}

const map = ([a, b]: readonly [number, number], f: (value: number) => number): [number, number] => [
  f(a),
  f(b)
]

/** Densities at an altitude, and the position in the absorber's layer. */
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
  const air = slopes.mul(altitude).negate().exp2()
  return {
    density: vec3(air, inLayer.abs().oneMinus().max(0)).toConst(),
    inLayer
  }
}

/** Vertical column of the absorber above a point at y of the {@link Profile}, over half its layer's width. */
export function absorberAbove(inLayer: Float): Float {
  const rest = inLayer.abs().oneMinus().max(0).toConst() as Float
  const half = rest.mul(rest).mul(0.5).toConst() as Float
  return inLayer.lessThan(0).select(half.oneMinus(), half)
}

/**
 * Column of the absorber to space along a ray that does not descend, over {@link absorberAbove} [m]:
 * w/√(μ² + 2d/r_bottom), where d is the height of the middle of what is above as the horizon weighs it.
 *
 * Exact overhead; on the horizon d is exact from the layer's middle up, and within 2 % below it.
 *
 * @param inLayer - y of the {@link Profile}.
 * @param square - μ².
 */
function absorberLength(
  { absorptionHalfWidth }: AtmosphereUniforms,
  { absorberWidth }: ProfileConstants,
  inLayer: Float,
  square: Float
): Float {
  const below = inLayer.mul(-0.68).add(HORIZON_WEIGHT).max(inLayer.add(0.18).negate())
  const d = below.max(inLayer.mul(-HORIZON_WEIGHT).add(HORIZON_WEIGHT)).max(1e-3)
  return absorptionHalfWidth.mul(d.mul(absorberWidth).add(square).inverseSqrt())
}

/**
 * Columns of molecules, aerosols and absorber from a point to space along a ray that ascends, over both
 * densities and {@link absorberAbove} [m]: see {@link columnsToSpace}. About 1/μ, they vary slowly.
 *
 * @param inLayer - y of the {@link Profile}.
 * @param cosView - μ, or −μ.
 */
export function lengthsToSpace(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  inLayer: Float,
  cosView: Float
): Vec3 {
  const { horizon, steepness } = constants
  const air = horizon.mul(scaledErfc(steepness.mul(cosView.abs()).toConst()))
  return vec3(air, absorberLength(uniforms, constants, inLayer, cosView.mul(cosView)))
}

/**
 * Columns of molecules, aerosols and absorber from a point to space, in closed form: equivalent lengths
 * of air of density 1 [m].
 *
 * In exponential air the column of an ascending ray is n √(π r H/2) e^{z²} erfc z, z = μ √(r/2H). That of a
 * ray descending to an altitude h_t is twice the horizontal column there less the column backwards.
 * Molecules and aerosols are within 1.5 % of exponentials, air above `topRadius` included; the absorber is within 5 %
 * from below its layer, and within 30 % along the horizon from within it.
 *
 * @param altitude - h, in the air [m].
 * @param cosView - μ, not below the horizon.
 * @param profile - {@link profileAt} that altitude.
 * @see Chapman 1931, Proc. Phys. Soc. 43, 483, part II (grazing incidence); Schüler, "An approximation to the
 *   Chapman grazing-incidence function for atmospheric scattering", GPU Pro 3, pp. 105–118. Twin: `opticalDepth`
 *   of cpu/transmittance.ts, by quadrature
 */
export function columnsToSpace(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  altitude: Float,
  cosView: Float,
  { density, inLayer }: Profile
): Vec3 {
  const lengths = lengthsToSpace(uniforms, constants, inLayer, cosView)
  const columns = lengths.mul(vec3(density.xy, absorberAbove(inLayer))).toVar()
  If(cosView.lessThan(0), () => {
    const radius = uniforms.bottomRadius.add(altitude)
    const square = cosView.mul(cosView).toConst()
    const drop = radius.mul(square).div(square.oneMinus().max(0).sqrt().add(1))
    const lowest = profileAt(uniforms, constants, altitude.sub(drop).max(0).toConst())
    const above = absorberAbove(lowest.inLayer)
    const absorber = absorberLength(uniforms, constants, lowest.inLayer, float(0)).mul(above)
    const level = vec3(constants.horizon.mul(lowest.density.xy), absorber)
    columns.assign(level.mul(2).sub(columns).max(0))
  })
  return columns
}
