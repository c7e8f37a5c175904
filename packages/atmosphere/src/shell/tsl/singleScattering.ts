import { If } from 'three/tsl'
import type { Air } from '../../scattering/tsl/ray'
import type { ProfileConstants } from './chapman'
import { denseEnd, marchHighSun, suitsHighSun } from './marchHighSun'
import { marchSingleScattering } from './marchSingleScattering'
import type { AirSegment } from './shellMarch'
import type { MediumSegment } from '../../skyVolume/tsl/skyVolume'
import { SingleScatteringSums } from './singleScatteringSums'

/**
 * Singly scattered sunlight along a segment, without tables: a few points on it, and a closed form for the
 * air between each point and the sun. Columns of the three constituents are summed instead of extinctions
 * at four wavelengths.
 */
export function singleScatteringLight(
  { uniforms }: Air,
  constants: ProfileConstants,
  segment: AirSegment
): MediumSegment {
  const sums = new SingleScatteringSums(uniforms)
  const dense = denseEnd(uniforms, segment)
  If(suitsHighSun(uniforms, segment, dense), () => {
    marchHighSun(uniforms, constants, segment, dense, sums)
  }).Else(() => marchSingleScattering(uniforms, constants, segment, sums))
  return sums.result(segment.cosViewLight)
}
