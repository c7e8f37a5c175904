import { scalePhase, type CloudPhaseParameters } from '../../src/light/cpu/cloudPhase'
import { LEAST_ASYMMETRY } from '../../src/light/tsl/cloudPhase'

/** The Henyey–Greenstein phase function [1/sr]. @param cosScatter - Cosine of the scattering angle. */
export function henyeyGreenstein(asymmetry: number, cosScatter: number): number {
  const squaredChord = 1 + asymmetry ** 2 - 2 * asymmetry * cosScatter
  return (1 - asymmetry ** 2) / (4 * Math.PI * squaredChord ** 1.5)
}

/** Both lobes [1/sr]. @param cosScatter - Cosine of the scattering angle. */
export function cloudPhase(phase: CloudPhaseParameters, cosScatter: number): number {
  const { forwardAsymmetry, backwardAsymmetry, forwardShare } = phase
  return (
    forwardShare * henyeyGreenstein(forwardAsymmetry, cosScatter) +
    (1 - forwardShare) * henyeyGreenstein(backwardAsymmetry, cosScatter)
  )
}

/**
 * The phase function near the light, after the peak has been broadened by scattering in it n times on
 * the way [1/sr].
 *
 * Legendre terms l ≥ 3 of a lobe are g³ g^{l−3}: what the delta-scaling takes as unscattered, and a
 * peak that is itself Henyey–Greenstein's. Scattered n times in it, with n Poisson of mean X, those
 * terms become Σ_n g^{n(l−3)} X^{n−1} e^{−X}/n!, here A h^{l−3} with A = (1 − e^{−X})/X, their sum, and
 * h = g^{1/A}, as 1/A is the mean of n.
 *
 * @param depth - Scaled depth from the light to the sample and on to the camera.
 */
export function aureolePhase(
  phase: CloudPhaseParameters,
  cosScatter: number,
  depth: number
): number {
  const { forwardAsymmetry: g, backwardAsymmetry, forwardShare, scatteringAlbedo } = phase
  const { depthScale } = scalePhase(phase)
  const mean = Math.max((scatteringAlbedo * forwardShare * g ** 3 * depth) / depthScale, 1e-3)
  const left = (1 - Math.exp(-mean)) / mean
  const h = Math.max(g ** (1 / left), LEAST_ASYMMETRY)
  /** Terms l ≤ 2 of a Henyey–Greenstein function. */
  const low = (a: number): number =>
    (1 + 3 * a * cosScatter + (5 / 2) * a * a * (3 * cosScatter ** 2 - 1)) / (4 * Math.PI)
  const lobe = low(g) + left * (g / h) ** 3 * (henyeyGreenstein(h, cosScatter) - low(h))
  return forwardShare * lobe + (1 - forwardShare) * henyeyGreenstein(backwardAsymmetry, cosScatter)
}
