import type { ScatteringPhase } from '@welkin/atmosphere'
import { mix } from 'three/tsl'
import type { CloudLight, FineSampleNodes } from '../CloudLightTable'
import type { Float, Vec4 } from '../../tsl-types'
import { singlePhase } from './cloudPhase'

/**
 * Share of scattered light that is only diffracted, by large particles.
 *
 * @see Bohren & Huffman 1983, "Absorption and scattering of light by small particles", §4.4.3
 */
const DIFFRACTED = 0.5

/**
 * Fine structure: what a phase function has over the lobes, in light that was scattered once and diffracted any number of
 * times on its way; as it is in light scattered exactly once, in the rest blurred by one diffraction. The lobes are those of
 * `cloudSource`, broadened about the light. Depths are not delta-scaled here, τ = τ′/`depthScale`; all scattering but diffraction dims it.
 * Radiance per scaled extinction, for unit irradiance above the cloud [1/sr]. Twin: test/twins/fineStructure.ts
 */
export function fineStructure(
  light: CloudLight,
  particles: ScatteringPhase,
  sample: FineSampleNodes
): Vec4 {
  const { cosViewLight, depthToLight, depthToCamera } = sample
  const scaled = depthToLight.add(depthToCamera).toConst() as Float
  const depth = scaled.div(light.depthScale).toConst() as Float
  // The march counts scaled depths to the camera by itself.
  const left = depthToCamera.sub(depth.mul(1 - DIFFRACTED)).exp()
  const once = depth.mul(-DIFFRACTED).exp()
  const phase = particles.phase(sample)
  const blurred = particles.diffracted?.(sample) ?? phase
  const fine = mix(blurred, phase, once).sub(singlePhase(light, cosViewLight, scaled))
  return fine.mul(left.mul(light.scatteringScale))
}
