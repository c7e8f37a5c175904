/** A star of a catalogue. */
export interface Star {
  /** Right ascension at the mean equator and equinox of J2000, in [0, 2π) [rad]. */
  ascension: number
  /** Declination, same frame [rad]. */
  declination: number
  /** Apparent visual magnitude; less is brighter. */
  magnitude: number
  /** Colour index B − V; less is bluer [mag]. */
  colorIndex: number
}

/** Size of an encoded star: 20 bits each for right ascension and declination, 8 each for magnitude and colour. */
export const BYTES_PER_STAR = 7

const STEPS = 2 ** 20
const MAGNITUDES = { min: -1.5, step: 0.03 }
const COLOR_INDICES = { min: -0.4, step: 0.015 }

const byte = (value: number, { min, step }: { min: number; step: number }): number =>
  Math.min(Math.max(Math.round((value - min) / step), 0), 255)

/** Writes a star, rounded to 0.6″ in right ascension and 0.3″ in declination. */
export function encodeStar(star: Star, bytes: Uint8Array, index: number): void {
  const ascension = Math.round((star.ascension / (2 * Math.PI)) * STEPS) % STEPS
  const declination = Math.round((star.declination / Math.PI + 0.5) * (STEPS - 1))
  const at = index * BYTES_PER_STAR
  bytes[at] = ascension >> 12
  bytes[at + 1] = (ascension >> 4) & 255
  bytes[at + 2] = ((ascension & 15) << 4) | (declination >> 16)
  bytes[at + 3] = (declination >> 8) & 255
  bytes[at + 4] = declination & 255
  bytes[at + 5] = byte(star.magnitude, MAGNITUDES)
  bytes[at + 6] = byte(star.colorIndex, COLOR_INDICES)
}

/** Reads a star written by {@link encodeStar}. */
export function decodeStar(bytes: Uint8Array, index: number): Star {
  const at = index * BYTES_PER_STAR
  const ascension = (bytes[at] << 12) | (bytes[at + 1] << 4) | (bytes[at + 2] >> 4)
  const declination = ((bytes[at + 2] & 15) << 16) | (bytes[at + 3] << 8) | bytes[at + 4]
  return {
    ascension: (ascension / STEPS) * 2 * Math.PI,
    declination: (declination / (STEPS - 1) - 0.5) * Math.PI,
    magnitude: MAGNITUDES.min + MAGNITUDES.step * bytes[at + 5],
    colorIndex: COLOR_INDICES.min + COLOR_INDICES.step * bytes[at + 6]
  }
}
