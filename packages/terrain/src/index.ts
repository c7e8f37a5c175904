export { Terrain } from './Terrain'
export type { TerrainOptions } from './Terrain'
export { Walker } from './walk/Walker'
export type { WalkerOptions, WalkerState } from './walk/Walker'
export type { Ground } from './rays/Ground'
export { MountainHeights } from './heights/MountainHeights'
export type { MountainHeightsOptions } from './heights/MountainHeights'
export type { HeightSample, HeightSource, SurfacePoint } from './heights/HeightSource'

// For height sources of one's own: noise that the CPU and the GPU agree on, anywhere on a planet.
export { latticeNoise } from './noise/tsl/latticeNoise'
export { latticeNoise as latticeNoiseOnCPU } from './noise/cpu/latticeNoise'
export type { Noise } from './noise/cpu/latticeNoise'
