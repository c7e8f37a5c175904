/** Tones of a picture as a viewer sees it. */
export interface Tones {
  /** Mean of its channels, in [0, 1]. */
  mean: number
  /** Part of its pixels with a channel at 254 or more of 255, in [0, 1]. */
  clipped: number
}

/** Luminance below which a picture is of a night [cd/m²]. */
const NIGHT = 1

/** Most of a picture that may be clipped, outside of the sun's disc [–]. */
const CLIPPED = 0.03

/** Means of pictures of days [–]. */
const DAYS = [0.2, 0.5] as const
/**
 * Means of pictures of nights, which stay dark and are not black [–]. `autoExposure` alone gives 0.02, of stars, to 0.2, as its
 * GPU test says; a story's pictures have dusk, lamps or moonlight, some with a compensation.
 */
const NIGHTS = [0.04, 0.35] as const
/** Least mean where black space fills most of the picture [–]. */
const IN_SPACE = 0.1

/** Least and greatest mean of a picture that is exposed for a luminance [cd/m²]. */
const meansAt = (luminance: number, isInSpace: boolean): readonly [number, number] =>
  luminance < NIGHT ? NIGHTS : [isInSpace ? IN_SPACE : DAYS[0], DAYS[1]]

/**
 * Fault of how a picture is exposed; undefined where there is none.
 *
 * @param luminance - Luminance that it is exposed for [cd/m²].
 * @param isInSpace - True where black space fills most of it.
 * @param compensation - Exposure over that, for a dark part of it, of which the rest may be bright, or below it, for a bright one [EV].
 */
export function toneFault(
  { mean, clipped }: Tones,
  luminance: number,
  isInSpace = false,
  compensation = 0
): string | undefined {
  if (compensation < 0) return undefined
  const [least, most] = meansAt(luminance, isInSpace)
  if (compensation > 0)
    return mean >= least ? undefined : `its mean is ${mean.toFixed(3)}, not ${least} at least`
  if (!(clipped <= CLIPPED))
    return `${(100 * clipped).toFixed(1)} % is clipped, not ${100 * CLIPPED} % at most`
  if (mean >= least && mean <= most) return undefined
  return `its mean is ${mean.toFixed(3)}, not ${least} to ${most}`
}

/**
 * Tones of a picture in sRGB.
 *
 * @param rgba - Four numbers a pixel.
 * @param white - Number that stands for 1.
 */
export function tonesOf(rgba: ArrayLike<number>, white: number): Tones {
  let [sum, clipped] = [0, 0]
  for (let i = 0; i < rgba.length; i += 4) {
    const [r, g, b] = [rgba[i], rgba[i + 1], rgba[i + 2]]
    sum += (r + g + b) / 3
    if (Math.max(r, g, b) > (253.5 / 255) * white) clipped++
  }
  const pixels = rgba.length / 4
  return { mean: sum / pixels / white, clipped: clipped / pixels }
}
