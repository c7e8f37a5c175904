import type { CloudLight } from '../CloudLightTable'
import { lateralLeakFit as fit } from '../cpu/lateralLeak'
import type { Float } from '../../tsl-types'

/** Extent of a cloud about a sample. All depths are scaled optical depths. */
export interface LeakNodes {
  /** Depth from the sample to the light, ≥ 0. */
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
    .mul(depthAcross.min(fit.largestDiameter))
    .add(1)
    .log()
    .toConst()
  const chord = depthThrough.div(depthAcross.max(1e-4)).clamp().toConst()
  const byPart = part.mul(fit.part2).add(depth.mul(fit.partDepth)).add(chord.mul(fit.partChord))
  const byDepth = depth.mul(fit.depth2).add(chord.mul(fit.depthChord)).add(fit.depth)
  return byPart
    .add(fit.part)
    .mul(part)
    .add(byDepth.mul(depth))
    .add(chord.mul(fit.chord2).add(fit.chord).mul(chord))
    .add(fit.constant)
    .mul(layered.oneMinus())
    .exp()
}
