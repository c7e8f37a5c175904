/** How cloud droplets scatter: two Henyey–Greenstein lobes. */
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
 * @see Wiscombe 1977, "The delta-M method"
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

/** The Henyey–Greenstein phase function [1/sr]. @param cosScatter - Of the scattering angle. */
export function henyeyGreenstein(asymmetry: number, cosScatter: number): number {
  const squaredChord = 1 + asymmetry ** 2 - 2 * asymmetry * cosScatter
  return (1 - asymmetry ** 2) / (4 * Math.PI * squaredChord ** 1.5)
}

/** Both lobes [1/sr]. @param cosScatter - Of the scattering angle. */
export function cloudPhase(phase: CloudPhaseParameters, cosScatter: number): number {
  const { forwardAsymmetry, backwardAsymmetry, forwardShare } = phase
  return (
    forwardShare * henyeyGreenstein(forwardAsymmetry, cosScatter) +
    (1 - forwardShare) * henyeyGreenstein(backwardAsymmetry, cosScatter)
  )
}

/** Least asymmetry of the broadened lobe: below it, terms cancel in float32 and none is left to see. */
export const LEAST_ASYMMETRY = 0.2

/**
 * The phase function near the sun, after the peak has been broadened by scattering in it n times on
 * the way [1/sr].
 *
 * Legendre terms l ≥ 3 of a lobe are g³ g^{l−3}: what the delta-scaling takes as unscattered, and a
 * peak that is itself Henyey–Greenstein's. Scattered n times in it, with n Poisson of mean X, those
 * terms become Σ_n g^{n(l−3)} X^{n−1} e^{−X}/n!, here A h^{l−3} with A = (1 − e^{−X})/X, their sum, and
 * h = g^{1/A}, as 1/A is the mean of n.
 *
 * @param depth - Scaled depth from the sun to the sample and on to the eye.
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
