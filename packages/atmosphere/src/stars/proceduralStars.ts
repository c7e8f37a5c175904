import { checkOptions, fail } from '@welkin/geo'
import { checkRange } from '../check'
import type { Star } from './starEncoding'

/** Options of {@link proceduralStars}. */
export interface ProceduralStarsOptions {
  /** Number of stars, an integer in [1, 50000], default 5000. */
  count?: number
  /** Magnitude of the faintest star, in [−10, 20], default 6. */
  faintest?: number
  /** Seed of the random numbers, finite, default 1: the same seed gives the same sky. */
  seed?: number
}

/** Growth of the number of stars to magnitude m, 10^(0.51 m): `brightStars()` has 15 to magnitude 1 and 1,608 to 5. */
const COUNT_EXPONENT = 0.51

/** Magnitudes between the faintest and the brightest star, which is about as bright as Sirius. */
const MAGNITUDE_SPAN = 7.5

/**
 * Random stars with the real sky's distribution of magnitudes and colours: for other worlds, and where
 * the catalogue's 36 kB are too much.
 *
 * @throws If an option is out of range.
 */
export function proceduralStars(options: ProceduralStarsOptions = {}): Star[] {
  const {
    count = 5000,
    faintest = 6,
    seed = 1
  } = checkOptions('proceduralStars', options, 'count', 'faintest', 'seed')
  if (!(Number.isInteger(count) && count >= 1 && count <= 50_000)) {
    fail('proceduralStars', 'count must be an integer in [1, 50000]', count)
  }
  checkRange('proceduralStars', 'faintest', faintest, -10, 20)
  if (!Number.isFinite(seed)) fail('proceduralStars', 'seed must be finite', seed)
  const next = random(seed)
  return Array.from({ length: count }, () => {
    const ascension = 2 * Math.PI * next()
    const declination = Math.asin(2 * next() - 1)
    const magnitude = faintest + Math.max(Math.log10(1 - next()) / COUNT_EXPONENT, -MAGNITUDE_SPAN)
    // Two peaks of colour: stars like Sirius and Vega, and orange giants.
    const deviation = (next() + next() + next() - 1.5) * 0.5
    const colorIndex = (next() < 0.55 ? 0.1 : 1.1) + deviation
    return { ascension, declination, magnitude, colorIndex }
  })
}

/** Mulberry32: pseudo-random numbers in [0, 1). */
function random(seed: number): () => number {
  let state = Math.floor(seed) | 0
  return () => {
    state = (state + 0x6d2b79f5) | 0
    let x = Math.imul(state ^ (state >>> 15), 1 | state)
    x = (x + Math.imul(x ^ (x >>> 7), 61 | x)) ^ x
    return ((x ^ (x >>> 14)) >>> 0) / 4294967296
  }
}
