/** Tones of a picture as a viewer sees it. */
export interface Tones {
  /** Mean of its channels, in [0, 1]. */
  mean: number
  /** Part of its pixels with a channel at 254 or more of 255, in [0, 1]. */
  clipped: number
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
