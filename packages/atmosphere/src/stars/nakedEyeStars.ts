import { checkOptions } from '@welkin/geo'
import { STARS_OPTIONS, Stars, type StarsOptions } from './Stars'
import { brightStars } from './brightStars'

/**
 * Stars, by default the 5,044 that the naked eye sees: see {@link Stars}. Their catalogue is 36 kB, gzipped;
 * `new Stars({ catalogue })` is without it.
 */
export function stars(options: StarsOptions = {}): Stars {
  const { catalogue = brightStars() } = checkOptions('Stars', options, ...STARS_OPTIONS)
  return new Stars({ ...options, catalogue })
}
