/**
 * Illuminance of level ground on a clear moonless night [lx]: airglow 5e-4, stars 2e-4, the Milky Way and
 * unresolved starlight 1.5e-4.
 */
export const NIGHT_ILLUMINANCE = 8.5e-4

/**
 * Fit of log₁₀ of illuminance: upper bound of a range of the sun's elevations [°], and coefficients of
 * the powers of elevation/90°.
 *
 * @see Seidelmann (ed.) 1992, Explanatory Supplement to the Astronomical Almanac, table 9.32.1,
 *   after Janiczek & DeYoung 1987, US Naval Observatory Circular 171
 */
const ALMANAC_RANGES = [
  [90, 3.74, 3.97, -4.07, 1.47],
  [20, 3.05, 13.28, -45.98, 64.33],
  [5, 2.88, 22.26, -207.64, 1034.3],
  [-0.8, 2.88, 21.81, -258.11, -858.36],
  [-5, 2.7, 12.17, -431.69, -1899.83],
  [-12, 13.84, 262.72, 1447.42, 2797.93]
] as const

/**
 * Illuminance of level ground by sun and clear sky on Earth, as almanacs tabulate it. With the sun 18° or
 * more below the horizon it is that of the night sky, 6.5e-4 lx.
 *
 * @param elevationDegrees - Elevation of the sun's centre, in [−90, 90] [°].
 * @returns [lx]
 * @see Explanatory Supplement to the Astronomical Almanac 1992, table 9.32.1
 */
export function almanacIlluminance(elevationDegrees: number): number {
  const x = Math.max(elevationDegrees, -18) / 90
  const [, a, b, c, d] =
    ALMANAC_RANGES.findLast(([top]) => elevationDegrees <= top) ?? ALMANAC_RANGES[0]
  return 10 ** (a + b * x + c * x ** 2 + d * x ** 3)
}
