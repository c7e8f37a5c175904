import { angleAt, placeOf } from './phaseGrid'
import { HALF_TEXELS } from './phaseRow'

/**
 * x sin θ within which a disc diffracts 1/16, 3/16, … 15/16 of its light, by 1 − J₀² − J₁².
 *
 * @see Born & Wolf 1999, "Principles of optics", 7th ed., §8.5.2, eq. 18
 */
const QUANTILES = [0.508, 0.912, 1.227, 1.526, 1.844, 2.232, 2.941, 9.846]

/** Directions about the middle that are averaged. */
const SPOKES = 8

/** Wavelength that stands for sunlight [µm]. */
const WAVELENGTH = 0.55

/**
 * Phase function after light was diffracted by droplets on its way: the mean over the pattern of a disc.
 *
 * @param texels - Phase function, four numbers for each of `texelCosine`.
 * @param radius - Radius of the droplets [µm].
 */
export function diffractedRow(texels: Float32Array, radius: number): Float32Array {
  const size = (2 * Math.PI * radius) / WAVELENGTH
  const shifts = QUANTILES.flatMap(quantile =>
    Array.from({ length: SPOKES }, (_, k) => {
      const spoke = ((k + 0.5) / SPOKES) * Math.PI
      const shift = quantile / size
      return [shift * Math.cos(spoke), shift * Math.sin(spoke)]
    })
  )
  const last = HALF_TEXELS - 1
  const result = new Float32Array(texels.length)
  for (let texel = 0; texel < 2 * HALF_TEXELS; texel++) {
    const isBack = texel > last
    const angle = angleAt((isBack ? 2 * HALF_TEXELS - 1 - texel : texel) / last)
    for (const [along, aside] of shifts) {
      // Flat about either end, where patterns are small and structure is fine.
      const place = placeOf(Math.hypot(angle + along, aside)) * last
      const at = Math.min(isBack ? 2 * HALF_TEXELS - 1 - place : place, 2 * HALF_TEXELS - 1)
      const from = Math.min(Math.floor(at), 2 * HALF_TEXELS - 2)
      for (let i = 4 * texel, k = 0; k < 4; k++) {
        const a = texels[4 * from + k]
        const b = texels[4 * from + 4 + k]
        result[i + k] += (a + (b - a) * (at - from)) / shifts.length
      }
    }
  }
  return result
}
