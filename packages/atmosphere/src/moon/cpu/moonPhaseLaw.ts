/** Largest phase angle with measurements; beyond it the light falls as a lit crescent's does [rad]. */
const MAX_MEASURED_ANGLE = (150 * Math.PI) / 180

/** Measured phase law, 10^(−0.4 Δm) at a phase angle [rad]. */
function measuredPhaseLaw(angle: number): number {
  const degrees = (angle * 180) / Math.PI
  return 10 ** (-0.4 * (0.026 * degrees + 4e-9 * degrees ** 4))
}

/**
 * Phase function of a Lommel–Seeliger sphere, 1 when full: 1 − sin(α/2) tan(α/2) ln cot(α/4).
 *
 * @param angle - Phase angle α, between sun and observer at the moon, in [0, π] [rad].
 * @see Hapke 2012, Theory of Reflectance and Emittance Spectroscopy, 2nd ed., §11.4
 */
export function lommelSeeligerPhase(angle: number): number {
  // Limits, where the terms overflow or cancel.
  if (angle < 1e-9) return 1
  if (angle > Math.PI - 1e-5) return 0
  const half = angle / 2
  return 1 - Math.sin(half) * Math.tan(half) * Math.log(1 / Math.tan(half / 2))
}

/**
 * Brightness of the moon's ground at a phase angle over that at full moon, apart from the
 * Lommel–Seeliger law: the steep rise towards the full moon.
 *
 * @param angle - α, in [0, π] [rad].
 */
export function surfacePhaseFactor(angle: number): number {
  const measured = Math.min(angle, MAX_MEASURED_ANGLE)
  return measuredPhaseLaw(measured) / lommelSeeligerPhase(measured)
}

/**
 * Phase law of the moon: its light at a phase angle over that of the full moon.
 *
 * Δm = 0.026 |α| + 4·10⁻⁹ α⁴, α in degrees. Past 150° the ground keeps its brightness and the crescent
 * narrows. The opposition surge of the last degrees, near the Earth's shadow, is left out.
 *
 * @param angle - α, in [0, π] [rad].
 * @see Krisciunas & Schaefer 1991, eq. 9, after Allen 1976, §66
 */
export function moonPhaseLaw(angle: number): number {
  return surfacePhaseFactor(angle) * lommelSeeligerPhase(angle)
}
