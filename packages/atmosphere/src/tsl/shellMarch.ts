import { If, float, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../AtmosphereUniforms'
import { loop, type Float, type Vec4 } from '../tsl-types'
import { altitudeAlong, distanceToTop } from './boundary'
import { miePhase, rayleighPhase } from './phase'
import {
  pointAlong,
  scatterSegment,
  scatteredRadiance,
  segmentDepth,
  stepExponent,
  type Air,
  type Ray
} from './scattering'

/** Light scattered towards the start of a ray [1/sr], and optical depth of the way. */
export interface Shell {
  radiance: Vec4
  depth: Vec4
}

/** Part y of the way in steps that grow from 0: (e^{κy} − 1)/(e^κ − 1). */
const grown = (exponent: Float, part: Float): Float =>
  exponent.mul(part).exp().sub(1).div(exponent.exp().sub(1))

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
  steps: number,
  visit: (start: Float, end: Float) => void
): void {
  const { bottomRadius } = uniforms
  const { altitude, cosView } = ray
  const lowest = bottomRadius.add(altitude).mul(cosView).negate().clamp(0, length).toConst()
  const floor = altitudeAlong(altitude, cosView, lowest, bottomRadius).max(0).toConst()
  const ceiling = altitudeAlong(altitude, cosView, length, bottomRadius).max(0).toConst()
  const falling = stepExponent(uniforms, altitude.sub(floor).max(0)).toConst()
  const rising = stepExponent(uniforms, ceiling.sub(floor).max(0)).toConst()
  const before = lowest.div(length.max(1e-3)).mul(steps).round().toConst()
  const after = float(steps).sub(before).toConst()
  const start = float(0).toVar()
  loop('step', steps, step => {
    const passed = float(step).add(1).toConst()
    const down = lowest.mul(grown(falling, passed.div(before.max(1)).oneMinus()).oneMinus())
    const up = length.sub(lowest).mul(grown(rising, passed.sub(before).div(after.max(1))))
    const end = passed.lessThanEqual(before).select(down, lowest.add(up)).toConst()
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

/** Segments of the view ray and of those to the sun; two points each. */
const VIEW_SEGMENTS = 4
const SUN_SEGMENTS = 2

/** Sunlight at a point of a ray by a march of four points to the sun, without a table. */
function marchedSunlight(air: Air, ray: Ray, distance: Float, name: string): Vec4 {
  const { uniforms } = air
  const { bottomRadius, thickness, sunAngularRadius } = uniforms
  const { altitude, cosSun } = pointAlong(air, ray, distance)
  const radius = bottomRadius.add(altitude).toConst()
  const sinHorizon = bottomRadius.div(radius).toConst()
  const cosHorizon = altitude.mul(bottomRadius.mul(2).add(altitude)).sqrt().div(radius).negate()
  // The part of the sun's disc that the planet leaves free.
  const margin = sinHorizon.mul(sunAngularRadius).max(1e-4)
  const free = cosSun.sub(cosHorizon).div(margin).mul(0.5).add(0.5).clamp().toConst()
  const light = vec4(0).toVar()
  If(free.greaterThan(0), () => {
    const cosView = cosSun.max(cosHorizon).toConst() as Float
    const toSun: Ray = { altitude, cosView, cosSun: cosView, cosViewSun: cosView }
    const length = distanceToTop(altitude, cosView, bottomRadius, thickness).toConst()
    const exponent = stepExponent(uniforms, thickness.sub(altitude)).toConst()
    const depth = vec4(0).toVar()
    const start = float(0).toVar()
    loop(name, SUN_SEGMENTS, step => {
      const end = length.mul(grown(exponent, float(step).add(1).div(SUN_SEGMENTS))).toConst()
      depth.addAssign(segmentDepth(air, toSun, start, end).depth)
      start.assign(end)
    })
    light.assign(depth.negate().exp().mul(free))
  })
  return light
}

/**
 * Sunlight scattered once along a ray, without tables: 8 points on the ray, 4 on the way from each to
 * the sun.
 *
 * @param length - Of the way, which does not cross the ground [m].
 */
export function singleScatteringShell(air: Air, ray: Ray, length: Float): Shell {
  const { uniforms } = air
  const radiance = vec4(0).toVar()
  const depth = vec4(0).toVar()
  const molecules = uniforms.rayleighScattering.mul(rayleighPhase(ray.cosViewSun)).toConst()
  const aerosols = uniforms.mieScattering.mul(miePhase(uniforms, ray.cosViewSun)).toConst()
  marchFromLowest(uniforms, ray, length, VIEW_SEGMENTS, (start, end) => {
    const segment = segmentDepth(air, ray, start, end)
    const { half, first, second } = segment
    // Depths from the segment's start to its two points, of the line through both extinctions.
    const toFirst = first.extinction.mul(0.5).add(second.extinction.mul(0.5 - 1 / Math.sqrt(3)))
    const toSecond = first.extinction.mul(0.5 + 1 / Math.sqrt(3)).add(second.extinction.mul(0.5))
    for (const [node, way, name] of [
      [first, toFirst, 'near'],
      [second, toSecond, 'far']
    ] as const) {
      const scattering = molecules.mul(node.density.x).add(aerosols.mul(node.density.y))
      const through = depth.add(way.mul(half).max(0)).negate().exp().mul(half)
      const sunlight = marchedSunlight(air, ray, node.distance, name)
      radiance.addAssign(scattering.mul(through).mul(sunlight))
    }
    depth.addAssign(segment.depth)
  })
  return { radiance: radiance, depth: depth }
}
