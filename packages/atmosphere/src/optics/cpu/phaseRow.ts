import type { Triple } from '../../air/cpu/color'
import { colorSpectrum } from './colorSpectrum'
import { angleAt, type PhaseGrid } from './phaseGrid'

/** Texels of a phase function in each half: from the light to a quarter turn, and from there to the point opposite. */
export const HALF_TEXELS = 256

/** Phase function as shaders read it. */
export interface PhaseRow {
  /** Four wavelengths of each texel [1/sr]. */
  readonly texels: Float32Array
  /** Legendre coefficients χ₁ to χ₃ of its luminance. */
  readonly moments: readonly [number, number, number]
}

/** Cosine of the scattering angle at a texel, in [0, 2 · 256). */
export function texelCosine(texel: number): number {
  const isBack = texel >= HALF_TEXELS
  const fromEnd = isBack ? 2 * HALF_TEXELS - 1 - texel : texel
  const cosine = Math.cos(angleAt(fromEnd / (HALF_TEXELS - 1)))
  return isBack ? -cosine : cosine
}

/** Catmull–Rom spline through four even values. @param x - In [0, 1], from the second to the third. */
function spline(values: readonly number[], x: number): number {
  const [a, b, c, d] = values
  return b + 0.5 * x * (c - a + x * (2 * a - 5 * b + 4 * c - d + x * (3 * (b - c) + d - a)))
}

/**
 * Phase function as shaders read it, of one that was stored: interpolated in its logarithm, and made to scatter all light.
 *
 * @param colors - Red, green and blue of each sample of the grid, over sunlight's colour [1/sr].
 */
export function phaseRow(colors: ArrayLike<number>, { forward, backward }: PhaseGrid): PhaseRow {
  const texels = new Float32Array(8 * HALF_TEXELS)
  const luminances = new Float64Array(2 * HALF_TEXELS)
  for (let texel = 0; texel < 2 * HALF_TEXELS; texel++) {
    const isBack = texel >= HALF_TEXELS
    const [from, count] = isBack ? [forward, backward] : [0, forward]
    const fromEnd = isBack ? 2 * HALF_TEXELS - 1 - texel : texel
    const place = (fromEnd / (HALF_TEXELS - 1)) * (count - 1)
    const i = Math.min(Math.floor(place), count - 2)
    const color = [0, 1, 2].map(channel => {
      // Even about both ends: a quarter turn is smooth, too.
      const around = [i - 1, i, i + 1, i + 2].map(n =>
        Math.log(colors[3 * (from + Math.min(Math.abs(n), count - 1)) + channel])
      )
      return Math.exp(spline(around, place - i))
    }) as Triple
    texels.set(colorSpectrum(color), 4 * texel)
    luminances[texel] = 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]
  }
  const sums = [0, 0, 0, 0]
  for (let texel = 1; texel < 2 * HALF_TEXELS; texel++) {
    const [a, b] = [texelCosine(texel - 1), texelCosine(texel)]
    const middle = (a + b) / 2
    const share = Math.PI * (a - b) * (luminances[texel - 1] + luminances[texel])
    const square = middle * middle
    const legendre = [1, middle, 1.5 * square - 0.5, middle * (2.5 * square - 1.5)]
    legendre.forEach((value, l) => (sums[l] += share * value))
  }
  for (let i = 0; i < texels.length; i++) texels[i] /= sums[0]
  return { texels, moments: [1, 2, 3].map(l => sums[l] / sums[0]) as [number, number, number] }
}
