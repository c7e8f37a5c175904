/** Phase function of cloud droplets: two Henyey–Greenstein lobes. */
export interface CloudPhaseParameters {
  /** Asymmetry g of the first lobe, in [0, 0.95]: the forward peak that makes silver linings. */
  readonly forwardAsymmetry: number
  /** Asymmetry g of the second lobe, in [−0.95, 0.95]; negative ones scatter back. */
  readonly backwardAsymmetry: number
  /** Share of the light that the first lobe scatters, in [0, 1]. */
  readonly forwardShare: number
  /** Share of the extinguished light that is scattered, in [0, 0.99999]; droplets' is nearly 1. */
  readonly scatteringAlbedo: number
}

/** Droplets of fair-weather clouds: a strong forward peak and a weak broad back lobe. */
export const fairWeatherPhase: CloudPhaseParameters = {
  forwardAsymmetry: 0.8,
  backwardAsymmetry: -0.2,
  forwardShare: 0.8,
  scatteringAlbedo: 0.99999
}

/**
 * A phase function whose forward peak counts as light that was not scattered: what is left is smooth
 * enough for three Legendre terms.
 */
export interface ScaledPhase {
  /** 1 − ωf: optical depths times this are scaled depths τ′. */
  readonly depthScale: number
  /** Single-scattering albedo of what is left. */
  readonly albedo: number
  /** Legendre coefficients χ′₀ … χ′₂ of what is left; χ′₀ is 1. */
  readonly moments: readonly [number, number, number]
}

/**
 * Delta-scaling by the fourth Legendre coefficient: f = χ₃, χ′_l = (χ_l − f)/(1 − f),
 * τ′ = (1 − ωf) τ, ω′ = ω (1 − f)/(1 − ωf).
 *
 * @see Wiscombe 1977, "The delta-M method", J. Atmos. Sci. 34, 1408, eqs. 14 (moments), 15 (f) and 20 (depth and
 *   albedo), for M = 3/2
 */
export function scalePhase(phase: CloudPhaseParameters): ScaledPhase {
  const { forwardAsymmetry, backwardAsymmetry, forwardShare, scatteringAlbedo } = phase
  const chi = (l: number): number =>
    forwardShare * forwardAsymmetry ** l + (1 - forwardShare) * backwardAsymmetry ** l
  const peak = Math.max(chi(3), 0)
  const depthScale = 1 - scatteringAlbedo * peak
  return {
    depthScale,
    albedo: (scatteringAlbedo * (1 - peak)) / depthScale,
    moments: [1, (chi(1) - peak) / (1 - peak), (chi(2) - peak) / (1 - peak)]
  }
}
