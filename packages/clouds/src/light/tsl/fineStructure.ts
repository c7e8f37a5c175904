import type { ScatteringPhase } from '@welkin/atmosphere'
import { mix } from 'three/tsl'
import type { CloudLight, FineSampleNodes } from '../CloudLightTable'
import type { Float, Vec4 } from '../../tsl-types'
import { henyeyGreenstein } from './cloudPhase'

/**
 * Share of scattered light that is only diffracted, by large particles.
 *
 * @see Bohren & Huffman 1983, "Absorption and scattering of light by small particles", §4.4.3
 */
const DIFFRACTED = 0.5

/** Both lobes [1/sr]. @param cosScatter - Cosine of the scattering angle. Twin: test/twins/cloudPhase.ts (`cloudPhase`) */
export function lobes(light: CloudLight, cosScatter: Float): Float {
  const { forwardAsymmetry, backwardAsymmetry, forwardShare } = light
  const back = henyeyGreenstein(backwardAsymmetry, cosScatter)
  return mix(back, henyeyGreenstein(forwardAsymmetry, cosScatter), forwardShare)
}

/**
 * Fine structure: what a phase function has over the lobes, in light that was scattered once and diffracted any number of times
 * on its way; as it is in light scattered exactly once, in the rest blurred by one diffraction. Depths are not delta-scaled here, τ = τ′/`depthScale`;
 * all scattering but diffraction dims it. Per scaled extinction, as `cloudSource`. Twin: test/twins/fineStructure.ts
 */
export function fineStructure(
  light: CloudLight,
  particles: ScatteringPhase,
  sample: FineSampleNodes
): Vec4 {
  const { cosViewLight, depthToLight, depthToCamera } = sample
  const depth = depthToLight.add(depthToCamera).div(light.depthScale).toConst() as Float
  // The march counts scaled depths to the camera by itself.
  const left = depthToCamera.sub(depth.mul(1 - DIFFRACTED)).exp()
  const once = depth.mul(-DIFFRACTED).exp()
  const phase = particles.phase(sample)
  const blurred = particles.diffracted?.(sample) ?? phase
  const fine = mix(blurred, phase, once).sub(lobes(light, cosViewLight))
  return fine.mul(left.mul(light.scatteringScale))
}
