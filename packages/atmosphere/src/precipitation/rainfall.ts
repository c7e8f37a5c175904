import type { Atmosphere } from '../Atmosphere'
import { rain } from './ParticleKind'
import { Precipitation } from './Precipitation'
import type { PrecipitationOptions } from './PrecipitationOptions'

/** Rain around the camera: see {@link Precipitation}. */
export const rainfall = (atmosphere: Atmosphere, options?: PrecipitationOptions): Precipitation =>
  new Precipitation(atmosphere, rain, options)
