import type { Atmosphere } from '../Atmosphere'
import { snow } from './ParticleKind'
import { Precipitation } from './Precipitation'
import type { PrecipitationOptions } from './PrecipitationOptions'

/** Snow around the camera: see {@link Precipitation}. */
export const snowfall = (atmosphere: Atmosphere, options?: PrecipitationOptions): Precipitation =>
  new Precipitation(atmosphere, snow, options)
