import { If, vec3 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { gaussLegendre, weightsTo } from '../../math/cpu/quadrature'
import type { Bool, Float, Vec2 } from '../../tsl-types'
import { absorberAbove, lengthsToSpace, profileAt, type ProfileConstants } from './chapman'
import type { AirSegment } from './shellMarch'
import {
  COLUMN_UNIT,
  shellStepExponent,
  weighted,
  type SingleScatteringSums
} from './singleScatteringSums'

/** μ_s above which the sun counts as high, if it varies by less than a factor of two on the segment. */
const HIGH_SUN = 0.06

/** Largest thickness of the air over the planet's radius for which the five points suffice. */
const THIN_AIR = 0.2

/** Dense end of a segment that does not turn: its lower end, and the sun there. */
export interface DenseEnd {
  /** h [m]. */
  altitude: Float
  /** r μ of the ray outwards [m]. */
  radiusCosView: Float
  /** μ_s. */
  cosLight: Float
  /** μ_s at the other end. */
  cosLightAbove: Float
  /** The sun is high, and about as high all along the segment. */
  isSunny: Bool
  /** Both ends, and so all of the segment, are in the planet's shadow. */
  isDark: Bool
}

export function denseEnd(
  { bottomRadius, thickness, sunAngularRadius }: AtmosphereUniforms,
  { altitude, radius, radiusCosView, radiusCosSun, cosViewLight, hitsGround, length }: AirSegment
): DenseEnd {
  const ceiling = hitsGround.select(0, thickness).toConst() as Float
  const first = radiusCosSun.div(radius).toConst() as Float
  const along = cosViewLight.mul(length).add(radiusCosSun)
  const last = along.div(bottomRadius.add(ceiling)).toConst() as Float
  const least = first.min(last).toConst()
  const isSteady = first.max(last).lessThan(least.mul(2))
  // sin of the horizon's dip at the higher end, and no dip at the lower.
  const highest = altitude.max(ceiling).toConst()
  const dip = highest.mul(bottomRadius.mul(2).add(highest)).sqrt().div(bottomRadius.add(highest))
  return {
    altitude: hitsGround.select(0, altitude).toConst(),
    radiusCosView: hitsGround.select(radiusCosView.add(length).negate(), radiusCosView).toConst(),
    cosLight: hitsGround.select(last, first).toConst(),
    cosLightAbove: hitsGround.select(first, last).toConst(),
    isSunny: least.greaterThan(HIGH_SUN).and(isSteady).toConst(),
    isDark: first.max(last).add(dip).lessThan(sunAngularRadius.mul(-2)).toConst()
  }
}

/**
 * Sums singly scattered light for a segment under a high sun, or in the dark, by five points: as exact as
 * nine of `marchSingleScattering` at half the cost, since there are no roots and divisions.
 *
 * The points crowd at the dense end: their distance from it is the segment's length times a y + (1 − a) y³,
 * whose slope is about that of other marches' steps. With u = h + h²/2r_bottom, which is a square of the distance,
 * h = u − u²/2r_bottom + …. Lengths to space change as 1/μ_s does, in proportion to the distance.
 */
export function marchHighSun(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  { altitude, hitsGround, length }: AirSegment,
  dense: DenseEnd,
  sums: SingleScatteringSums
): void {
  const { bottomRadius, thickness } = uniforms
  const perRadius = bottomRadius.reciprocal().toConst() as Float
  const half = perRadius.mul(0.5).toConst() as Float
  const u0 = dense.altitude.mul(half).mul(dense.altitude).add(dense.altitude).toConst() as Float
  const u1 = dense.radiusCosView.mul(perRadius).toConst() as Float
  const rise = hitsGround.select(altitude, thickness.sub(altitude)).max(0)
  const exponent = shellStepExponent(constants, rise).toConst() as Float
  // κ/(e^κ − 1)
  const slope = exponent
    .mul(exponent.mul(exponent.mul(1 / 24).add(1 / 6)).add(0.5))
    .add(1)
    .reciprocal()
    .toConst() as Float
  const { inLayer } = profileAt(uniforms, constants, dense.altitude)
  const lengths = lengthsToSpace(uniforms, constants, inLayer, dense.cosLight)
    .mul(COLUMN_UNIT)
    .toConst()
  const change = dense.cosLightAbove.div(dense.cosLight).oneMinus().toConst()

  const { nodes, weights } = gaussLegendre(5)
  const points = nodes.map(node => {
    const fraction = slope
      .mul(node - node ** 3)
      .add(node ** 3)
      .toConst() as Float
    const distance = length.mul(fraction).toConst() as Float
    const u = distance.mul(half).add(u1).mul(distance).add(u0).toConst() as Float
    const profile = profileAt(uniforms, constants, u.mul(half).oneMinus().mul(u).toConst())
    const growth = slope.mul(1 - 3 * node ** 2).add(3 * node ** 2)
    return { ...profile, fraction, stretchedDensity: profile.density.mul(growth).toConst() }
  })
  const densities = points.map(point => point.stretchedDensity)
  const scaled = length.mul(COLUMN_UNIT).toConst() as Float
  sums.columns.assign(weighted(densities, weights).mul(scaled))
  If(dense.isDark.not(), () => {
    const sign = hitsGround.select(scaled.negate(), scaled).toConst()
    const base = hitsGround.select(sums.columns, vec3(0)).toConst()
    points.forEach(({ density, inLayer: y, fraction }, i) => {
      const above = vec3(density.xy, absorberAbove(y))
      const toSun = change.mul(fraction).add(1).mul(lengths).mul(above)
      const before = weighted(densities, weightsTo(nodes, nodes[i])).mul(sign).add(base).max(0)
      const scatterers = densities[i].xy.mul(length.mul(weights[i])).toConst() as Vec2
      sums.scatter(before.add(toSun).toConst(), scatterers)
    })
  })
}

/** {@link marchHighSun} is exact enough for a segment: a high or no sun, thin air, no lowest point within. */
export function suitsHighSun(
  { bottomRadius, thickness }: AtmosphereUniforms,
  { hitsGround, radiusCosView }: AirSegment,
  dense: DenseEnd
): Bool {
  const passesNearest = hitsGround.not().and(radiusCosView.lessThan(0))
  const isThin = thickness.lessThan(bottomRadius.mul(THIN_AIR))
  return dense.isSunny.or(dense.isDark).and(passesNearest.not()).and(isThin)
}
