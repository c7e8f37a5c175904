import { float, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { loop, type Bool, type Float, type Int, type Vec4 } from '../../tsl-types'
import { scatterSegment } from '../../scattering/tsl/segment'
import { scatteredRadiance } from '../../scattering/tsl/scattering'
import { stepExponent } from '../../scattering/tsl/march'
import type { Air, Ray } from '../../scattering/tsl/ray'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'

/** Segment of a ray in the air, to the ground or out of the air. */
export interface AirSegment {
  /** h at its start [m]. */
  altitude: Float
  /** r at its start [m]. */
  radius: Float
  /** r μ at its start: distance along the ray from the point nearest to the planet's centre [m]. */
  radiusCosView: Float
  /** r μ_s at its start [m]. */
  radiusCosSun: Float
  /** ν, against the sun. */
  cosViewLight: Float
  /** h of its lowest point [m]. */
  lowestAltitude: Float
  hitsGround: Bool
  /** Length of the segment [m]. */
  length: Float
}

/**
 * Steps along a segment, shortest at its lowest point, where the air is dense: few of them resolve a thin
 * limb as well as the ground.
 *
 * @param exponentOf - κ by the range of altitudes of a half [m], > 0.
 * @param visit - Called with both ends of a step [m].
 */
export function marchFromLowest(
  uniforms: AtmosphereUniforms,
  { altitude, radiusCosView, lowestAltitude: floor, hitsGround, length }: AirSegment,
  steps: number | Int,
  exponentOf: (rise: Float) => Float,
  visit: (start: Float, end: Float) => void
): void {
  const lowest = radiusCosView.negate().clamp(0, length).toConst() as Float
  const ceiling = hitsGround.select(0, uniforms.thickness)
  const falling = exponentOf(altitude.sub(floor).max(0)).toConst()
  const rising = exponentOf(ceiling.sub(floor).max(0)).toConst()
  // Distance from the lowest point after a fraction y of the steps: (e^{κy} − 1)/(e^κ − 1) of the half.
  const descent = lowest.negate().div(falling.exp().sub(1)).toConst()
  const ascent = length.sub(lowest).div(rising.exp().sub(1)).toConst()
  const count = float(steps as number).toConst() as Float
  const before = lowest.div(length.max(1e-3)).mul(count).round().toConst()
  const perDescent = falling.div(before.max(1)).toConst()
  const perAscent = rising.div(count.sub(before).max(1)).toConst()
  const start = float(0).toVar()
  loop('step', steps, step => {
    const passed = float(step).add(1).sub(before).toConst()
    const descends = passed.lessThanEqual(0).toConst() as Bool
    const exponent = passed.mul(descends.select(perDescent.negate(), perAscent))
    const end = lowest.add(exponent.exp().sub(1).mul(descends.select(descent, ascent))).toConst()
    visit(start, end)
    start.assign(end)
  })
}

/**
 * Light of the air along a segment from the tables, all orders of scattering.
 *
 * @param steps - Number of steps, two evaluations each.
 * @param scatter - Light scattered between two places of the segment; left out, without shadows.
 */
export function marchedShellLight(
  air: Air,
  segment: AirSegment,
  steps: number,
  scatter = scatterSegment
): MediumSegment {
  const { altitude, radius, radiusCosView, radiusCosSun, cosViewLight } = segment
  const ray: Ray = {
    altitude,
    cosView: radiusCosView.div(radius).clamp(-1, 1).toConst(),
    cosLight: radiusCosSun.div(radius).clamp(-1, 1).toConst(),
    cosViewLight
  }
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const depth = vec4(0).toVar()
  const exponentOf = (rise: Float): Float => stepExponent(air.uniforms, rise)
  marchFromLowest(air.uniforms, segment, steps, exponentOf, (start, end) => {
    const step = scatter(air, ray, start, end, { direct: true, diffuse: true })
    const transmittance = depth.negate().exp().toConst()
    molecular.addAssign(step.molecular.mul(transmittance))
    aerosol.addAssign(step.aerosol.mul(transmittance))
    depth.addAssign(step.depth)
  })
  const scattered = { molecular: molecular as unknown as Vec4, aerosol: aerosol as unknown as Vec4 }
  return { radiance: scatteredRadiance(air.uniforms, scattered, cosViewLight), depth: depth }
}
