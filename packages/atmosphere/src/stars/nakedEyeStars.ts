import { Stars, type StarsOptions } from './Stars'
import { brightStars } from './brightStars'

/** Layer of the 5,044 stars that the naked eye sees, see {@link Stars}. Its catalogue is 36 kB gzipped. */
export const stars = (options?: StarsOptions): Stars => new Stars(brightStars(), options)
