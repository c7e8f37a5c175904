import type { CloudLight } from '../CloudLightTable'
import * as c from '../cpu/lateralLeak'
import type { Float } from '../../tsl-types'

/** Extent of a cloud about a sample. All depths are scaled optical depths. */
export interface LeakNodes {
  /** From the sample to the light, ≥ 0. */
  depthToLight: Float
  /** Through the whole cloud along the ray of light through the sample, ≥ `depthToLight`. */
  depthThrough: Float
  /** Across that ray: the diameter of a sphere. Of no effect on a deck. */
  depthAcross: Float
  /** 1 for a cloud deck (plane-parallel), 0 for an isolated cloud, as wide as it is deep. */
  layered: Float
}

/**
 * Lateral leak: share of a slab's multiply scattered light that an isolated cloud, a sphere, keeps. Twin:
 * test/twins/cloudLight.ts
 */
export function lateralLeak(light: CloudLight, sample: LeakNodes): Float {
  const { depthToLight, depthThrough, depthAcross, layered } = sample
  const part = depthToLight.div(depthThrough.max(1e-4)).clamp().toConst()
  const depth = light.oneMinusAsymmetry
    .mul(depthAcross.min(c.largestDiameter))
    .add(1)
    .log()
    .toConst()
  const chord = depthThrough.div(depthAcross.max(1e-4)).clamp().toConst()
  const byPart = part.mul(c.part2).add(depth.mul(c.partDepth)).add(chord.mul(c.partChord))
  const byDepth = depth.mul(c.depth2).add(chord.mul(c.depthChord)).add(c.depth)
  return byPart
    .add(c.part)
    .mul(part)
    .add(byDepth.mul(depth))
    .add(chord.mul(c.chord2).add(c.chord).mul(chord))
    .add(c.constant)
    .mul(layered.oneMinus())
    .exp()
}
