export { Atmosphere } from './Atmosphere'
export type { AtmosphereFrame, AtmosphereOptions } from './Atmosphere'
export { AtmosphereParameters } from './AtmosphereParameters'
export type { AtmosphereParametersInit, SpectralMatrix, Spectrum } from './AtmosphereParameters'
