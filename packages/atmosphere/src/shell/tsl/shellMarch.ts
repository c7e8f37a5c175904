import { float, vec4 } from 'three/tsl'
import type { AtmosphereUniforms } from '../../air/AtmosphereUniforms'
import { loop, type Bool, type Float, type Int, type Vec4 } from '../../tsl-types'
import type { Eye } from '../../view/tsl/eye'
import {
  scatterSegment,
  scatteredRadiance,
  stepExponent,
  type Air,
  type Ray
} from '../../scattering/tsl/scattering'
import { sampleAir, type Sight } from '../../skyVolume/tsl/skyVolume'
import type { Texels } from '../../tables/TableAtlas'

/** Light scattered towards the start of a ray [1/sr], and optical depth of the way. */
export interface Shell {
  radiance: Vec4
  depth: Vec4
}

/** A way through the air, from where it starts to the ground or out of the air. */
export interface ShellRay {
  /** h at its start [m]. */
  altitude: Float
  /** r at its start [m]. */
  radius: Float
  /** r μ at its start: how far behind it is the point of the ray's line nearest to the centre [m]. */
  radial: Float
  /** r μ_s at its start [m]. */
  sunward: Float
  /** ν, against the sun. */
  cosViewSun: Float
  /** h of its lowest point [m]. */
  lowest: Float
  hitsGround: Bool
  /** [m] */
  length: Float
}

/**
 * Divides a way through the air at its lowest point, and both parts into segments that are short there,
 * where the air is dense: a march of few steps hits a thin limb as well as the ground.
 *
 * @param exponentOf - κ by the altitudes that a part spans [m], > 0.
 */
export function marchFromLowest(
  uniforms: AtmosphereUniforms,
  { altitude, radial, lowest: floor, hitsGround, length }: ShellRay,
  steps: number | Int,
  exponentOf: (rise: Float) => Float,
  visit: (start: Float, end: Float) => void
): void {
  const lowest = radial.negate().clamp(0, length).toConst() as Float
  const ceiling = hitsGround.select(0, uniforms.thickness)
  const falling = exponentOf(altitude.sub(floor).max(0)).toConst()
  const rising = exponentOf(ceiling.sub(floor).max(0)).toConst()
  // Distance from the lowest point at a part y of the steps: (e^{κy} − 1)/(e^κ − 1) of the way.
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
 * Light of the air along a way from the tables, all orders of scattering.
 *
 * @param steps - Two evaluations each.
 */
export function tableShell(air: Air, way: ShellRay, steps: number): Shell {
  const { altitude, radius, radial, sunward, cosViewSun } = way
  const ray: Ray = {
    altitude,
    cosView: radial.div(radius).clamp(-1, 1).toConst(),
    cosSun: sunward.div(radius).clamp(-1, 1).toConst(),
    cosViewSun
  }
  const molecular = vec4(0).toVar()
  const aerosol = vec4(0).toVar()
  const depth = vec4(0).toVar()
  const exponentOf = (rise: Float): Float => stepExponent(air.uniforms, rise)
  marchFromLowest(air.uniforms, way, steps, exponentOf, (start, end) => {
    const segment = scatterSegment(air, ray, start, end, { sun: true, diffuse: true })
    const through = depth.negate().exp().toConst()
    molecular.addAssign(segment.molecular.mul(through))
    aerosol.addAssign(segment.aerosol.mul(through))
    depth.addAssign(segment.depth)
  })
  const scattered = { molecular: molecular as unknown as Vec4, aerosol: aerosol as unknown as Vec4 }
  return { radiance: scatteredRadiance(air.uniforms, scattered, cosViewSun), depth: depth }
}

/** Light of the air along a line of sight from a sky volume, all orders of scattering. */
export function volumeShell(
  uniforms: AtmosphereUniforms,
  atlas: Texels,
  eye: Eye,
  sight: Sight
): Shell {
  return sampleAir(uniforms, atlas, eye, sight)
}
