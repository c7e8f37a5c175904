import { brightStarData } from './brightStarData'
import { BYTES_PER_STAR, decodeStar, type Star } from './starEncoding'

let catalogue: Star[] | undefined

/**
 * The 5,044 stars to magnitude 6, brightest first: the naked eye's sky.
 *
 * Positions are of epoch and equinox J2000, within 0.7″; all but three dozen stars move by less than 1″ a
 * year, none by more than 8″. Magnitudes within 0.015, B − V within 0.008.
 *
 * @see d3-celestial (O. Frohn), after the Extended Hipparcos Compilation (Anderson & Francis 2012)
 */
export function brightStars(): readonly Star[] {
  if (catalogue === undefined) {
    const bytes = Uint8Array.from(atob(brightStarData), character => character.charCodeAt(0))
    const count = bytes.length / BYTES_PER_STAR
    catalogue = Array.from({ length: count }, (_, i) => decodeStar(bytes, i))
  }
  return catalogue
}
