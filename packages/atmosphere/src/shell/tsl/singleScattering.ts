import { If, float, int, vec3, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { gaussLegendre, weightsTo } from '../../math/cpu/quadrature'
import type { Bool, Float, Vec2, Vec3, Vec4 } from '../../tsl-types'
import {
  absorberAbove,
  columnsToSpace,
  lengthsToSpace,
  profileAt,
  type Profile,
  type ProfileConstants
} from './chapman'
import { extinction } from '../../air/tsl/medium'
import { miePhase, rayleighPhase } from '../../air/tsl/phase'
import type { Air } from '../../scattering/tsl/scattering'
import { marchFromLowest, type Shell, type ShellRay } from './shellMarch'

const weighted = (values: readonly Vec3[], weights: readonly number[]): Vec3 =>
  values.map((value, i) => value.mul(weights[i])).reduce((sum, part) => sum.add(part))

/** Columns in units of length over log₂ e, so that exp2 takes the depths that they give. */
const UNIT = Math.LOG2E

/** What a march of light that is scattered once sums up. */
class SingleScattering {
  /** Light scattered by molecules and by aerosols, without coefficients and phase functions [m]. */
  readonly molecular = vec4(0).toVar()
  readonly aerosol = vec4(0).toVar()
  /** Of the three constituents, times {@link UNIT} [m]. */
  readonly columns = vec3(0).toVar()
  readonly #uniforms: AtmosphereUniforms

  constructor(uniforms: AtmosphereUniforms) {
    this.#uniforms = uniforms
  }

  /**
   * @param crossed - Columns from the sun to the eye by way of a point, times {@link UNIT} [m].
   * @param amount - Columns of molecules and aerosols that scatter there [m].
   */
  scatter(crossed: Vec3, amount: Vec2): void {
    const through = extinction(this.#uniforms, crossed).negate().exp2().toConst()
    this.molecular.addAssign(through.mul(amount.x))
    this.aerosol.addAssign(through.mul(amount.y))
  }

  finish(cosViewSun: Float): Shell {
    const { rayleighScattering, mieScattering } = this.#uniforms
    const byMolecules = this.molecular.mul(rayleighScattering).mul(rayleighPhase(cosViewSun))
    const byAerosols = this.aerosol.mul(mieScattering).mul(miePhase(this.#uniforms, cosViewSun))
    return {
      radiance: byMolecules.add(byAerosols),
      depth: extinction(this.#uniforms, this.columns.mul(1 / UNIT))
    }
  }
}

/** A point of a ray in the light of the sun. */
interface SunlitPoint extends Profile {
  altitude: Float
  /** μ_s, not below the horizon. */
  cosSun: Float
  /** Part of the sun's disc that the planet leaves free. */
  free: Float
}

/** μ_s above which the sun is above the horizon wherever it is seen from, by more than its radius. */
const HIGH_SUN = 0.02

function sunlitPoint(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  { radius, radial, sunward, cosViewSun }: ShellRay,
  distance: Float
): SunlitPoint {
  const { bottomRadius, sunAngularRadius } = uniforms
  const rise = radial.mul(2).add(distance).mul(distance)
  const square = radius.mul(radius).add(rise).max(1).toConst() as Float
  const inverse = square.inverseSqrt().toConst() as Float
  // Rounded to metres: air does not change in a metre.
  const altitude = square.mul(inverse).sub(bottomRadius).max(0).toConst() as Float
  const cosSun = distance.mul(cosViewSun).add(sunward).mul(inverse).clamp(-1, 1).toVar()
  const free = float(1).toVar()
  If(cosSun.lessThan(sunAngularRadius.max(HIGH_SUN)), () => {
    const dip = altitude.mul(bottomRadius.mul(2).add(altitude)).sqrt().mul(inverse).toConst()
    const margin = bottomRadius.mul(inverse).mul(sunAngularRadius).max(1e-4)
    free.assign(cosSun.add(dip).div(margin).mul(0.5).add(0.5).clamp())
    cosSun.assign(cosSun.max(dip.negate()))
  })
  return {
    ...profileAt(uniforms, constants, altitude),
    altitude,
    cosSun: cosSun,
    free: free
  }
}

/** κ of steps over a range of altitudes: never 0, where they would be 0/0. */
const exponentOf =
  ({ growth }: ProfileConstants) =>
  (rise: Float): Float =>
    growth.mul(rise).clamp(0.05, 4)

/** Optical depth behind which nothing is seen. */
const OPAQUE = 7

/** A way as far as it is seen: not beyond the lowest point of one that turns in thick air. */
function seenWay(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  way: ShellRay,
  turns: Bool
): ShellRay {
  const { density } = profileAt(uniforms, constants, way.lowest)
  const columns = vec3(constants.horizon.mul(density.xy), 0) as Vec3
  const depth = extinction(uniforms, columns).toConst() as Vec4
  const isOpaque = depth.x.min(depth.y).min(depth.z.min(depth.w)).greaterThan(OPAQUE)
  const length = turns.and(isOpaque).select(way.radial.negate().clamp(0, way.length), way.length)
  return { ...way, length: length.toConst() }
}

/** Sums the light of any way under any sun, in segments of three points. */
function marchAny(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  way: ShellRay,
  sums: SingleScattering
): void {
  const { altitude, radial, hitsGround } = way
  const isShort = altitude.lessThan(uniforms.homogeneousHeight.mul(1.25))
  const turns = hitsGround.not().and(radial.lessThan(0)).toConst() as Bool
  const overGround = turns.select(4, 3)
  const steps = int(hitsGround.select(isShort.select(1, 3), overGround)).toConst()
  const seen = seenWay(uniforms, constants, way, turns)
  const { nodes, weights } = gaussLegendre(3)
  marchFromLowest(uniforms, seen, steps, exponentOf(constants), (start, end) => {
    const step = end.sub(start).toConst() as Float
    const scaled = step.mul(UNIT).toConst()
    const points = nodes.map(node =>
      sunlitPoint(uniforms, constants, way, step.mul(node).add(start).toConst() as Float)
    )
    const found = points.map(({ density }) => density)
    points.forEach((point, i) => {
      const { altitude: height, cosSun, density, free } = point
      If(free.greaterThan(0), () => {
        const toSun = columnsToSpace(uniforms, constants, height, cosSun, point).mul(UNIT)
        const before = weighted(found, weightsTo(nodes, nodes[i])).mul(scaled).max(0)
        const crossed = before.add(sums.columns).add(toSun).toConst() as Vec3
        sums.scatter(crossed, density.xy.mul(step.mul(free).mul(weights[i])).toConst())
      })
    })
    sums.columns.addAssign(weighted(found, weights).mul(scaled))
  })
}

/** μ_s from which on the sun is high, if it is not twice as much elsewhere on the way. */
const STEADY_SUN = 0.06

/** Thickness of air over the planet's radius that {@link marchSunny} is right for. */
const THIN = 0.2

/** Where the air of a way that does not turn is densest, at one of its ends, and the sun there. */
interface DenseEnd {
  /** h [m]. */
  altitude: Float
  /** r μ of the way outwards [m]. */
  radial: Float
  /** μ_s. */
  cosSun: Float
  /** μ_s at the other end. */
  cosSunAbove: Float
  /** Whether the sun shines on the whole way from about as high up. */
  isSunny: Bool
  /** Whether the planet's shadow, which is convex, holds both ends. */
  isDark: Bool
}

function denseEnd(
  { bottomRadius, thickness, sunAngularRadius }: AtmosphereUniforms,
  { altitude, radius, radial, sunward, cosViewSun, hitsGround, length }: ShellRay
): DenseEnd {
  const ceiling = hitsGround.select(0, thickness).toConst() as Float
  const first = sunward.div(radius).toConst() as Float
  const along = cosViewSun.mul(length).add(sunward)
  const last = along.div(bottomRadius.add(ceiling)).toConst() as Float
  const least = first.min(last).toConst()
  const isSteady = first.max(last).lessThan(least.mul(2))
  // sin of the horizon's dip at the higher end, and no dip at the lower.
  const highest = altitude.max(ceiling).toConst()
  const dip = highest.mul(bottomRadius.mul(2).add(highest)).sqrt().div(bottomRadius.add(highest))
  return {
    altitude: hitsGround.select(0, altitude).toConst(),
    radial: hitsGround.select(radial.add(length).negate(), radial).toConst(),
    cosSun: hitsGround.select(last, first).toConst(),
    cosSunAbove: hitsGround.select(first, last).toConst(),
    isSunny: least.greaterThan(STEADY_SUN).and(isSteady).toConst(),
    isDark: first.max(last).add(dip).lessThan(sunAngularRadius.mul(-2)).toConst()
  }
}

/**
 * Sums the light of a way through thin air under a high sun, or in the dark, by five points: as right as
 * nine of {@link marchAny} at half the cost, for there are no roots and divisions.
 *
 * From the dense end outwards the distance is that to the top times a y + (1 − a) y³, of about the slopes
 * that the steps of other marches have. With u = h + h²/2r_bottom, which is a square of the distance,
 * h = u − u²/2r_bottom + …. Lengths to space change as 1/μ_s does, in proportion to the distance.
 */
function marchSunny(
  uniforms: AtmosphereUniforms,
  constants: ProfileConstants,
  { altitude, hitsGround, length }: ShellRay,
  dense: DenseEnd,
  sums: SingleScattering
): void {
  const { bottomRadius, thickness } = uniforms
  const perRadius = bottomRadius.reciprocal().toConst() as Float
  const half = perRadius.mul(0.5).toConst() as Float
  const u0 = dense.altitude.mul(half).mul(dense.altitude).add(dense.altitude).toConst() as Float
  const u1 = dense.radial.mul(perRadius).toConst() as Float
  const rise = hitsGround.select(altitude, thickness.sub(altitude)).max(0)
  const exponent = exponentOf(constants)(rise).toConst() as Float
  // κ/(e^κ − 1)
  const slope = exponent
    .mul(exponent.mul(exponent.mul(1 / 24).add(1 / 6)).add(0.5))
    .add(1)
    .reciprocal()
    .toConst() as Float
  const { inLayer } = profileAt(uniforms, constants, dense.altitude)
  const lengths = lengthsToSpace(uniforms, constants, inLayer, dense.cosSun).mul(UNIT).toConst()
  const change = dense.cosSunAbove.div(dense.cosSun).oneMinus().toConst()

  const { nodes, weights } = gaussLegendre(5)
  const points = nodes.map(node => {
    const part = slope
      .mul(node - node ** 3)
      .add(node ** 3)
      .toConst() as Float
    const distance = length.mul(part).toConst() as Float
    const u = distance.mul(half).add(u1).mul(distance).add(u0).toConst() as Float
    const profile = profileAt(uniforms, constants, u.mul(half).oneMinus().mul(u).toConst())
    const growth = slope.mul(1 - 3 * node ** 2).add(3 * node ** 2)
    return { ...profile, part, found: profile.density.mul(growth).toConst() }
  })
  const found = points.map(point => point.found)
  const scaled = length.mul(UNIT).toConst() as Float
  sums.columns.assign(weighted(found, weights).mul(scaled))
  If(dense.isDark.not(), () => {
    const sign = hitsGround.select(scaled.negate(), scaled).toConst()
    const base = hitsGround.select(sums.columns, vec3(0)).toConst()
    points.forEach(({ density, inLayer: y, part }, i) => {
      const above = vec3(density.xy, absorberAbove(y))
      const toSun = change.mul(part).add(1).mul(lengths).mul(above)
      const before = weighted(found, weightsTo(nodes, nodes[i])).mul(sign).add(base).max(0)
      const amount = found[i].xy.mul(length.mul(weights[i])).toConst() as Vec2
      sums.scatter(before.add(toSun).toConst(), amount)
    })
  })
}

/**
 * Sunlight scattered once along a ray, without tables: a few points on it, and a closed form for the air
 * between each and the sun. Columns of the three constituents are summed, not extinctions of four
 * wavelengths.
 */
export function singleScatteringShell(
  { uniforms }: Air,
  constants: ProfileConstants,
  way: ShellRay
): Shell {
  const sums = new SingleScattering(uniforms)
  const { bottomRadius, thickness } = uniforms
  const dense = denseEnd(uniforms, way)
  const turns = way.hitsGround.not().and(way.radial.lessThan(0))
  const isThin = thickness.lessThan(bottomRadius.mul(THIN))
  If(dense.isSunny.or(dense.isDark).and(turns.not()).and(isThin), () => {
    marchSunny(uniforms, constants, way, dense, sums)
  }).Else(() => marchAny(uniforms, constants, way, sums))
  return sums.finish(way.cosViewSun)
}
