import { type Triple, xyzToLinearSRGB } from '../../../src/air/cpu/color'

/** Chromaticities of linear sRGB's primaries (IEC 61966-2-1), and their parts of white's luminance. */
const PRIMARIES = [
  { x: 0.64, y: 0.33, luminance: 0.2126729 },
  { x: 0.3, y: 0.6, luminance: 0.7151522 },
  { x: 0.15, y: 0.06, luminance: 0.072175 }
]

/** Chromaticity x of white, D65, by its X, Y and Z. */
const WHITE_X = 0.95047 / (0.95047 + 1 + 1.08883)

/** Chromaticity of night. */
export const NIGHT = { x: 0.27, y: 0.277 }

/** Scotopic luminance over photopic by chromaticity: 1 + (Y + Z)/X = 1/x. */
const scotopicRatio = (x: number): number => 1.33 / x - 1.68

/** Eyes that see a picture: see `Sight`. */
export interface SightNumbers {
  luminanceScale: number
  adaptation: number
  strength: number
}

/** Luminance of linear sRGB. */
export const luminanceOf = (color: Readonly<Triple>): number =>
  PRIMARIES.reduce((sum, { luminance }, i) => sum + luminance * color[i], 0)

/** Float64 twin of `purkinjeShift`, by the chromaticity of the sum of the primaries, and in decades. */
export function purkinjeShift(
  color: Readonly<Triple>,
  { luminanceScale, adaptation, strength }: SightNumbers
): Triple {
  const photopic = luminanceOf(color)
  // X + Y + Z of each primary is Y/y, X is x Y/y.
  const sums = PRIMARIES.map(({ y, luminance }, i) => (color[i] * luminance) / y)
  const sum = sums.reduce((total, each) => total + each, 0)
  if (sum === 0) return [...color]
  const x = PRIMARIES.reduce((total, primary, i) => total + primary.x * sums[i], 0) / sum
  const grey = (photopic * scotopicRatio(x)) / scotopicRatio(WHITE_X)
  const decades = Math.log10(Math.max(photopic / luminanceScale, adaptation) / 0.005)
  const t = Math.min(Math.max(decades / 3, 0), 1)
  // 1 − smoothstep, about the middle of the range.
  const rods = strength * (0.5 + (0.5 - t) * (1.5 - 2 * (0.5 - t) ** 2))
  const sumOfNight = grey / NIGHT.y
  const night = xyzToLinearSRGB([NIGHT.x * sumOfNight, grey, (1 - NIGHT.x - NIGHT.y) * sumOfNight])
  return color.map((value, i) => value * (1 - rods) + night[i] * rods) as Triple
}
