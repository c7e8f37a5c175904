/**
 * Phase function of molecules [1/sr].
 *
 * @param cosViewLight - ν, cosine of the scattering angle.
 */
export function rayleighPhase(cosViewLight: number): number {
  return (3 / (16 * Math.PI)) * (1 + cosViewLight ** 2)
}

/** 3/(8π) (1 − g²)/(2 + g²): what is constant in the Cornette–Shanks phase function [1/sr]. */
export function cornetteShanksFactor(asymmetry: number): number {
  return ((3 / (8 * Math.PI)) * (1 - asymmetry ** 2)) / (2 + asymmetry ** 2)
}

/**
 * Phase function of aerosols [1/sr].
 *
 * @param asymmetry - g, in (−1, 1).
 * @param cosViewLight - ν, cosine of the scattering angle.
 * @see Cornette & Shanks 1992, "Physically reasonable analytic expression for the single-scattering phase
 *   function", Applied Optics 31, 3152, eq. 8
 */
export function cornetteShanksPhase(asymmetry: number, cosViewLight: number): number {
  const squaredChord = 1 + asymmetry ** 2 - 2 * asymmetry * cosViewLight
  return (cornetteShanksFactor(asymmetry) * (1 + cosViewLight ** 2)) / squaredChord ** 1.5
}

/**
 * Legendre coefficients χ₀ … χ₂ of the Cornette–Shanks phase function, p = Σ (2l + 1)/4π χ_l P_l.
 *
 * The function is Henyey–Greenstein's, whose coefficients are g^l, times 1 + ν²; ν² P_l expands
 * into P_{l−2}, P_l and P_{l+2}.
 */
export function asymmetryMoments(asymmetry: number): [number, number, number] {
  const g = asymmetry
  const norm = 1.5 / (2 + g * g)
  return [
    1,
    norm * (g + (2 / 5) * g ** 3 + (3 / 5) * g),
    norm * (g ** 2 + (12 / 35) * g ** 4 + (11 / 21) * g ** 2 + 2 / 15)
  ]
}
