import type { Atmosphere } from '../Atmosphere'
import { snow } from './ParticleKind'
import { Precipitation, type PrecipitationOptions } from './Precipitation'

/** Snow around the camera: see {@link Precipitation}. */
export const snowfall = (atmosphere: Atmosphere, options?: PrecipitationOptions): Precipitation =>
  new Precipitation(atmosphere, snow, options)
