import { Stars, type StarsOptions } from './Stars'
import { brightStars } from './brightStars'

/**
 * Stars, by default the 5,044 that the naked eye sees: see {@link Stars}. Their catalogue is 36 kB, gzipped;
 * `new Stars({ catalogue })` is without it.
 */
export const stars = (options: StarsOptions = {}): Stars =>
  new Stars({ ...options, catalogue: options.catalogue ?? brightStars() })
