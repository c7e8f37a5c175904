import { If, float, vec3, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { extinction } from '../../air/tsl/medium'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import type { Float, Vec2, Vec3 } from '../../tsl-types'
import { profileAt, type Profile, type ProfileConstants } from './chapman'
import type { AirSegment } from './shellMarch'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'

/** Weighted sum. */
export const weighted = (values: readonly Vec3[], weights: readonly number[]): Vec3 =>
  values.map((value, i) => value.mul(weights[i])).reduce((sum, part) => sum.add(part))

/** Factor on columns that makes exp2 of their depths what exp is without it. */
export const COLUMN_UNIT = Math.LOG2E

/** Sums of a march of singly scattered light. */
export class SingleScatteringSums {
  /** Light scattered by molecules, without coefficient and phase function [m]. */
  readonly molecular = vec4(0).toVar()
  /** Light scattered by aerosols, likewise [m]. */
  readonly aerosol = vec4(0).toVar()
  /** Columns of the three constituents passed so far, times {@link COLUMN_UNIT} [m]. */
  readonly columns = vec3(0).toVar()
  readonly #uniforms: AtmosphereUniforms

  constructor(uniforms: AtmosphereUniforms) {
    this.#uniforms = uniforms
  }

  /**
   * Adds the light scattered at a point.
   *
   * @param columns - Columns from the sun to the point and on to the camera, times {@link COLUMN_UNIT} [m].
   * @param scatterers - Columns of molecules and aerosols at the point [m].
   */
  scatter(columns: Vec3, scatterers: Vec2): void {
    const transmittance = extinction(this.#uniforms, columns).negate().exp2().toConst()
    this.molecular.addAssign(transmittance.mul(scatterers.x))
    this.aerosol.addAssign(transmittance.mul(scatterers.y))
  }

  /** Radiance and optical depth of the whole segment. */
  result(cosViewLight: Float): MediumSegment {
    const { rayleighScattering, mieScattering } = this.#uniforms
    const byMolecules = this.molecular.mul(rayleighScattering).mul(rayleighPhase(cosViewLight))
    const byAerosols = this.aerosol.mul(mieScattering).mul(miePhase(this.#uniforms, cosViewLight))
    return {
      radiance: byMolecules.add(byAerosols),
      depth: extinction(this.#uniforms, this.columns.mul(1 / COLUMN_UNIT))
    }
  }
}

/** Point of a segment in sunlight. */
export interface SunlitPoint extends Profile {
  /** h [m]. */
  altitude: Float
  /** μ_s, not below the horizon. */
  cosLight: Float
  /** Fraction of the sun's disc above the horizon. */
  visibleDisc: Float
}

/** μ_s above which the whole disc of the sun is above the horizon at any altitude. */
const HIGH_SUN = 0.02

/** Densities and sun at a distance along a segment [m]. */
export function sunlitPoint(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  { radius, radiusCosView, radiusCosSun, cosViewLight }: AirSegment,
  distance: Float
): SunlitPoint {
  const { bottomRadius, sunAngularRadius } = uniforms
  const rise = radiusCosView.mul(2).add(distance).mul(distance)
  const square = radius.mul(radius).add(rise).max(1).toConst() as Float
  const inverse = square.inverseSqrt().toConst() as Float
  // Rounded to metres: air does not change in a metre.
  const altitude = square.mul(inverse).sub(bottomRadius).max(0).toConst() as Float
  const cosLight = distance.mul(cosViewLight).add(radiusCosSun).mul(inverse).clamp(-1, 1).toVar()
  const visibleDisc = float(1).toVar()
  If(cosLight.lessThan(sunAngularRadius.max(HIGH_SUN)), () => {
    const dip = altitude.mul(bottomRadius.mul(2).add(altitude)).sqrt().mul(inverse).toConst()
    const margin = bottomRadius.mul(inverse).mul(sunAngularRadius).max(1e-4)
    visibleDisc.assign(cosLight.add(dip).div(margin).mul(0.5).add(0.5).clamp())
    cosLight.assign(cosLight.max(dip.negate()))
  })
  return {
    ...profileAt(uniforms, constants, altitude),
    altitude,
    cosLight,
    visibleDisc
  }
}

/** κ of steps over a range of altitudes: never 0, where they would be 0/0. */
export const shellStepExponent = ({ growth }: ProfileConstants, rise: Float): Float =>
  growth.mul(rise).clamp(0.05, 4)
