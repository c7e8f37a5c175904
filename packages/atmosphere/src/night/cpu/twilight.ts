/**
 * Illuminance of level ground in a clear night with no moon: by airglow 5e-4, by stars 2e-4, by the
 * Milky Way and what is too faint to be told apart 1.5e-4 [lx].
 */
export const NIGHT_ILLUMINANCE = 8.5e-4

/**
 * Illuminance of level ground by sun and clear sky, from day to night: upper bounds of a range of the
 * sun's elevations [°], and the coefficients of log₁₀ of illuminance, powers of elevation/90°.
 *
 * @see Seidelmann (ed.) 1992, Explanatory Supplement to the Astronomical Almanac, table 9.32.1;
 *   Janiczek & DeYoung 1987, US Naval Observatory Circular 171
 */
const RANGES = [
  [90, 3.74, 3.97, -4.07, 1.47],
  [20, 3.05, 13.28, -45.98, 64.33],
  [5, 2.88, 22.26, -207.64, 1034.3],
  [-0.8, 2.88, 21.81, -258.11, -858.36],
  [-5, 2.7, 12.17, -431.69, -1899.83],
  [-12, 13.84, 262.72, 1447.42, 2797.93]
] as const

/**
 * Illuminance of level ground by sun and clear sky on Earth, as the almanacs tabulate it. With the sun
 * 18° down and more it is the night sky's, 6.5e-4 lx.
 *
 * @param elevationDegrees - Of the sun's centre, in [−90, 90] [°].
 * @returns [lx]
 */
export function almanacIlluminance(elevationDegrees: number): number {
  const x = Math.max(elevationDegrees, -18) / 90
  const [, a, b, c, d] = RANGES.findLast(([top]) => elevationDegrees <= top) ?? RANGES[0]
  return 10 ** (a + b * x + c * x ** 2 + d * x ** 3)
}
