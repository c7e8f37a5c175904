const QUARTER = Math.PI / 2

/** Samples of a stored phase function: from the light to a quarter turn, and from the point opposite to it. */
export interface PhaseGrid {
  readonly forward: number
  readonly backward: number
}

/** Grid of stored droplets. */
export const dropletGrid: PhaseGrid = { forward: 64, backward: 96 }

/** Grid of stored crystals: halos are on the light's side. */
export const crystalGrid: PhaseGrid = { forward: 200, backward: 24 }

/**
 * Distance of a sample from the light or from the point opposite, w² π/2: samples crowd where aureole, corona and
 * glory are.
 *
 * @param w - In [0, 1].
 * @returns [rad].
 */
export const angleAt = (w: number): number => QUARTER * w * w

/** Place w of an angle from the light or from the point opposite: inverse of `angleAt`. @param angle - [rad]. */
export const placeOf = (angle: number): number => Math.sqrt(angle / QUARTER)
