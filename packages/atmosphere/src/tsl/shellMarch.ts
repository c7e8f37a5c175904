import { If, float, int, vec3, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import { loop, type Bool, type Float, type Int, type Vec3, type Vec4 } from '../tsl-types'
import { altitudeAlong } from './boundary'
import {
  columnsToSpace,
  profileAt,
  profileConstants,
  type Profile,
  type ProfileConstants
} from './chapman'
import type { Eye } from './eye'
import { extinction } from './medium'
import { miePhase, rayleighPhase } from './phase'
import { scatterSegment, scatteredRadiance, stepExponent, type Air, type Ray } from './scattering'
import { sampleAir, type Sight, type VolumeTextures } from './skyVolume'

/** Light scattered towards the start of a ray [1/sr], and optical depth of the way. */
export interface Shell {
  radiance: Vec4
  depth: Vec4
}

/**
 * Divides a way through the air at its lowest point, and both parts into segments that are short there,
 * where the air is dense: a march of few steps hits a thin limb as well as the ground.
 *
 * @param length - Of the way, which does not cross the ground [m].
 */
function marchFromLowest(
  uniforms: AtmosphereUniforms,
  ray: Ray,
  length: Float,
  steps: number | Int,
  visit: (start: Float, end: Float) => void
): void {
  const { bottomRadius } = uniforms
  const { altitude, cosView } = ray
  const lowest = bottomRadius.add(altitude).mul(cosView).negate().clamp(0, length).toConst()
  const floor = altitudeAlong(altitude, cosView, lowest, bottomRadius).max(0).toConst()
  const ceiling = altitudeAlong(altitude, cosView, length, bottomRadius).max(0).toConst()
  const falling = stepExponent(uniforms, altitude.sub(floor).max(0)).toConst()
  const rising = stepExponent(uniforms, ceiling.sub(floor).max(0)).toConst()
  // Distance from the lowest point at a part y of the steps: (e^{κy} − 1)/(e^κ − 1) of the way.
  const descent = lowest.negate().div(falling.exp().sub(1)).toConst()
  const ascent = length.sub(lowest).div(rising.exp().sub(1)).toConst()
  const count = float(steps as number).toConst() as Float
  const before = lowest.div(length.max(1e-3)).mul(count).round().toConst()
  const perDescent = before.max(1).reciprocal().toConst()
  const perAscent = count.sub(before).max(1).reciprocal().toConst()
  const start = float(0).toVar()
  loop('step', steps, step => {
    const passed = float(step).add(1).sub(before).toConst()
    const descends = passed.lessThanEqual(0).toConst() as Bool
    const part = passed.mul(descends.select(perDescent.negate(), perAscent))
    const grown = descends.select(falling, rising).mul(part).exp().sub(1)
    const end = lowest.add(grown.mul(descends.select(descent, ascent))).toConst()
    visit(start, end)
    start.assign(end)
  })
}

/**
 * Light of the air along a ray from the tables, all orders of scattering.
 *
 * @param length - Of the way, which does not cross the ground [m].
 * @param steps - Two evaluations each.
 */
export function tableShell(air: Air, ray: Ray, length: Float, steps: number): Shell {
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const depth = vec4(0).toVar()
  marchFromLowest(air.uniforms, ray, length, steps, (start, end) => {
    const segment = scatterSegment(air, ray, start, end, { sun: true, diffuse: true })
    const through = depth.negate().exp().toConst()
    molecular.addAssign(segment.molecular.mul(through))
    aerosol.addAssign(segment.aerosol.mul(through))
    depth.addAssign(segment.depth)
  })
  const scattered = { molecular: molecular as unknown as Vec4, aerosol: aerosol as unknown as Vec4 }
  return {
    radiance: scatteredRadiance(air.uniforms, scattered, ray.cosViewSun),
    depth: depth
  }
}

/** Light of the air along a line of sight from a sky volume, all orders of scattering. */
export function volumeShell(
  uniforms: AtmosphereUniforms,
  textures: VolumeTextures,
  eye: Eye,
  sight: Sight
): Shell {
  return sampleAir(uniforms, textures, eye, sight)
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
  ray: Ray,
  distance: Float
): SunlitPoint {
  const { bottomRadius, sunAngularRadius } = uniforms
  const start = bottomRadius.add(ray.altitude).toConst()
  const rise = start.mul(ray.cosView).mul(2).add(distance).mul(distance).toConst()
  const square = start.mul(start).add(rise).max(1).toConst()
  const inverse = square.inverseSqrt().toConst()
  const climb = rise.div(square.mul(inverse).add(start))
  const altitude = ray.altitude.add(climb).max(0).toConst() as Float
  const along = start.mul(ray.cosSun).add(distance.mul(ray.cosViewSun))
  const cosSun = along.mul(inverse).clamp(-1, 1).toVar()
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

/**
 * Segments of a ray where light is scattered once, two points each: 4 for the sky; less for ways to
 * the ground, which have no thin air to cross, least if they start low.
 */
function singleScatteringSteps(
  { rayleighScaleHeight }: AtmosphereUniforms,
  { altitude }: Ray,
  hitsGround: Bool
): Int {
  const isLow = altitude.lessThan(rayleighScaleHeight.mul(1.25))
  return int(hitsGround.select(isLow.select(2, 3), 4)).toConst()
}

const INVERSE_ROOT_3 = 1 / Math.sqrt(3)

/**
 * Sunlight scattered once along a ray, without tables: up to 8 points on the ray, and a closed form for
 * the air between each and the sun.
 *
 * Columns of the three constituents are summed, not extinctions of four wavelengths.
 *
 * @param sight - The same ray.
 */
export function singleScatteringShell(
  { uniforms }: Air,
  ray: Ray,
  { length, hitsGround }: Sight
): Shell {
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const columns = vec3(0).toVar()
  const constants = profileConstants(uniforms)
  const steps = singleScatteringSteps(uniforms, ray, hitsGround)
  marchFromLowest(uniforms, ray, length, steps, (start, end) => {
    const half = end.sub(start).mul(0.5).toConst()
    const [first, second] = [1 - INVERSE_ROOT_3, 1 + INVERSE_ROOT_3].map(node =>
      sunlitPoint(uniforms, constants, ray, start.add(half.mul(node)).toConst() as Float)
    ) as [SunlitPoint, SunlitPoint]
    // Columns from the segment's start to its two points, of the line through both densities.
    const toFirst = first.density.mul(0.5).add(second.density.mul(0.5 - INVERSE_ROOT_3))
    const toSecond = first.density.mul(0.5 + INVERSE_ROOT_3).add(second.density.mul(0.5))
    for (const [point, way] of [
      [first, toFirst],
      [second, toSecond]
    ] as const) {
      const { altitude, cosSun, density, free } = point
      If(free.greaterThan(0), () => {
        const toSun = columnsToSpace(uniforms, constants, altitude, cosSun, point)
        const crossed = columns.add(way.mul(half).max(0)).add(toSun).toConst() as Vec3
        const light = extinction(uniforms, crossed).negate().exp().mul(half.mul(free)).toConst()
        molecular.addAssign(light.mul(density.x))
        aerosol.addAssign(light.mul(density.y))
      })
    }
    columns.addAssign(first.density.add(second.density).mul(half))
  })
  const { cosViewSun } = ray
  const byMolecules = molecular.mul(uniforms.rayleighScattering).mul(rayleighPhase(cosViewSun))
  const byAerosols = aerosol.mul(uniforms.mieScattering).mul(miePhase(uniforms, cosViewSun))
  return {
    radiance: byMolecules.add(byAerosols),
    depth: extinction(uniforms, columns)
  }
}
