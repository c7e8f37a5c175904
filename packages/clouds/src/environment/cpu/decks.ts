/** Transmittances of a cloud deck, or of several at once: parts of unit flux. */
export interface CloudDeck {
  /** Diffuse light that passes. Clouds absorb nothing: the rest is reflected. */
  readonly diffuse: number
  /** Direct light that passes, scattered or not. */
  readonly direct: number
  /** Direct light that passes unscattered, or scattered within the forward peak. */
  readonly beam: number
}

/** Broken clouds: of one optical depth over a part of the sky. */
export interface BrokenClouds {
  /** Scaled optical thickness. */
  readonly thickness: number
  /** Part of the sky. */
  readonly coverage: number
  /** Rain or snow: under a share of these clouds, and as thick. */
  readonly fall?: { readonly share: number; readonly thickness: number }
}

const none = { share: 0, thickness: 0 }

/** Cosine of the lowest light; one below it counts as this. */
export const LOWEST_COSINE = 0.05

/**
 * Footprint on the clouds that light a plane: in heights of the clouds above it, and at least [m]. Smaller:
 * light under broken clouds changes with every gap (*Shadows*).
 */
export const footprintForm = { heights: 2, least: 1500 } as const

/** Footprint of a layer whose middle is so far above or below a plane [m]. */
export const deckFootprint = (rise: number): number =>
  Math.max(rise * footprintForm.heights, footprintForm.least)

/**
 * Transmittance of a cloud that absorbs nothing for light from one direction, in Eddington's approximation.
 *
 * @param thickness - Scaled optical thickness.
 * @param cosLight - μ_s, in (0, 1].
 * @param oneMinusAsymmetry - 1 − g′.
 * @see King & Harshvardhan 1986, "Comparative accuracy of selected multiple scattering approximations", J. Atmos.
 *   Sci. 43, pp. 784–801
 */
export function eddingtonTransmittance(
  thickness: number,
  cosLight: number,
  oneMinusAsymmetry: number
): number {
  const beam = Math.exp(-thickness / cosLight)
  return (2 + 3 * cosLight + (2 - 3 * cosLight) * beam) / (4 + 3 * oneMinusAsymmetry * thickness)
}

/** Transmittance for diffuse light: 1/(1 + ¾ (1 − g′) τ′). */
export function eddingtonDiffuse(thickness: number, oneMinusAsymmetry: number): number {
  return 4 / (4 + 3 * oneMinusAsymmetry * thickness)
}

/**
 * Transmittances of broken layers one above the other. Light between decks that absorb nothing goes to and
 * fro until 1/t − 1 add up, in whatever order.
 *
 * @param layers - Each with the clouds of regions that are equally frequent, of which the mean counts.
 */
export function stackDecks(
  layers: readonly (readonly BrokenClouds[])[],
  cosLight: number,
  oneMinusAsymmetry: number
): CloudDeck {
  const mu = Math.max(cosLight, LOWEST_COSINE)
  const means = (part: (thickness: number) => number): number[] =>
    layers.map(regions =>
      regions.reduce((sum, { coverage, thickness, fall = none }) => {
        const dry = (1 - fall.share) * part(thickness)
        const through = dry + fall.share * part(thickness + fall.thickness)
        return sum + (1 + coverage * (through - 1)) / regions.length
      }, 0)
    )
  const series = (parts: number[]): number =>
    1 / parts.reduce((sum, part) => sum + 1 / part, 1 - parts.length)
  return {
    diffuse: series(means(thickness => eddingtonDiffuse(thickness, oneMinusAsymmetry))),
    direct: series(means(thickness => eddingtonTransmittance(thickness, mu, oneMinusAsymmetry))),
    beam: means(thickness => Math.exp(-thickness / mu)).reduce((part, mean) => part * mean, 1)
  }
}
