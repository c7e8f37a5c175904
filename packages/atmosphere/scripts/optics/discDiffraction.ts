/** Radii of discs with the shadows of crystals [µm]: half of these, and half as large ones, count alike. */
export const CRYSTAL_RADII = [20, 28, 40, 56, 80]

/** Bessel function J₁, by its integral. */
function besselJ1(x: number): number {
  const steps = 60 + Math.ceil(Math.abs(x))
  let sum = 0
  for (let i = 0; i < steps; i++) {
    const angle = ((i + 0.5) * Math.PI) / steps
    sum += Math.cos(angle - x * Math.sin(angle))
  }
  return sum / steps
}

/**
 * Phase function of light that crystals diffract, as discs of their size do [1/sr].
 *
 * @param wavelength - [µm].
 * @returns Function of the angle from the light [°].
 * @see Born & Wolf 1999, "Principles of optics", 7th ed., §8.5.2, eq. 14
 */
export function discDiffraction(wavelength: number): (degrees: number) => number {
  const pattern = (degrees: number): number => {
    const sine = Math.sin((degrees * Math.PI) / 180)
    let sum = 0
    for (const radius of CRYSTAL_RADII) {
      const size = (2 * Math.PI * radius) / wavelength
      const u = Math.max(size * sine, 1e-6)
      sum += (size ** 2 / (4 * Math.PI)) * ((2 * besselJ1(u)) / u) ** 2
    }
    return sum / CRYSTAL_RADII.length
  }
  // Looked up, as it is needed often: even in the root of the angle.
  const count = 1200
  const table = Array.from({ length: count + 1 }, (_, i) => pattern(90 * (i / count) ** 2))
  return degrees => {
    const place = Math.sqrt(degrees / 90) * count
    const from = Math.min(Math.floor(place), count - 1)
    return table[from] + (table[from + 1] - table[from]) * (place - from)
  }
}
