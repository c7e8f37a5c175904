/** Work space of a sphere's scattering: coefficients, and functions of each angle. */
export interface MieAngles {
  readonly cosines: Float64Array
  /** |S₁|² + |S₂|² over 2 of the last sphere, for each cosine. */
  readonly intensity: Float64Array
}

/** @param cosines - Cosines of the scattering angles. */
export const mieAngles = (cosines: readonly number[]): MieAngles => ({
  cosines: Float64Array.from(cosines),
  intensity: new Float64Array(cosines.length)
})

/**
 * Light that a sphere without absorption scatters, by Lorenz and Mie's series.
 *
 * @param x - Size parameter, 2πr/λ.
 * @param m - Refractive index against the air's.
 * @param angles - Takes the intensity, which is the differential cross-section times (2π/λ)².
 * @returns Efficiency of scattering, and the asymmetry g.
 * @see Bohren & Huffman 1983, "Absorption and scattering of light by small particles", §4.4 (eqs. 4.61, 4.62, 4.74)
 *   and §4.8 (recurrences; number of terms of Wiscombe 1980)
 */
export function mieSphere(
  x: number,
  m: number,
  angles: MieAngles
): { efficiency: number; asymmetry: number } {
  const terms = Math.floor(x + 4.05 * Math.cbrt(x) + 2)
  const start = Math.floor(Math.max(terms, m * x)) + 16
  // Logarithmic derivative of ψ(mx), downwards.
  const derivative = new Float64Array(start + 1)
  for (let n = start; n > 0; n--) {
    const ratio = n / (m * x)
    derivative[n - 1] = ratio - 1 / (derivative[n] + ratio)
  }
  // Real and imaginary parts of a and b, times (2n + 1)/(n (n + 1)).
  const series = new Float64Array(4 * (terms + 1))
  let [psiBefore, psi, chiBefore, chi] = [Math.cos(x), Math.sin(x), -Math.sin(x), Math.cos(x)]
  let [efficiency, asymmetry] = [0, 0]
  let before = [0, 0, 0, 0]
  for (let n = 1; n <= terms; n++) {
    const nextPsi = ((2 * n - 1) * psi) / x - psiBefore
    const nextChi = ((2 * n - 1) * chi) / x - chiBefore
    ;[psiBefore, psi, chiBefore, chi] = [psi, nextPsi, chi, nextChi]
    const coefficient = (factor: number): [number, number] => {
      const sum = factor + n / x
      const top = sum * psi - psiBefore
      const side = sum * chi - chiBefore
      const square = top * top + side * side
      return [(top * top) / square, (top * side) / square]
    }
    const a = coefficient(derivative[n] / m)
    const b = coefficient(derivative[n] * m)
    const factor = (2 * n + 1) / (n * (n + 1))
    series.set([a[0] * factor, a[1] * factor, b[0] * factor, b[1] * factor], 4 * n)
    efficiency += (2 * n + 1) * (a[0] + b[0])
    asymmetry += factor * (a[0] * b[0] + a[1] * b[1])
    const neighbours = before[0] * a[0] + before[1] * a[1] + before[2] * b[0] + before[3] * b[1]
    asymmetry += (((n - 1) * (n + 1)) / n) * neighbours
    before = [...a, ...b]
  }
  const { cosines, intensity } = angles
  for (let i = 0; i < cosines.length; i++) intensity[i] = scatteredTo(cosines[i], series, terms)
  return { efficiency: (2 / x ** 2) * efficiency, asymmetry: (2 * asymmetry) / efficiency }
}

/** |S₁|² + |S₂|² over 2 at one cosine: sums of the angular functions π and τ. */
function scatteredTo(cosine: number, series: Float64Array, terms: number): number {
  let [pi, piBefore] = [1, 0]
  let [re1, im1, re2, im2] = [0, 0, 0, 0]
  for (let n = 1, k = 4; n <= terms; n++, k += 4) {
    const rising = cosine * pi
    const tau = n * rising - (n + 1) * piBefore
    re1 += series[k] * pi + series[k + 2] * tau
    im1 += series[k + 1] * pi + series[k + 3] * tau
    re2 += series[k] * tau + series[k + 2] * pi
    im2 += series[k + 1] * tau + series[k + 3] * pi
    const next = rising + ((n + 1) / n) * (rising - piBefore)
    piBefore = pi
    pi = next
  }
  return (re1 * re1 + im1 * im1 + re2 * re2 + im2 * im2) / 2
}
