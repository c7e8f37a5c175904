import type { LakeOptions } from '@welkin/terrain'

/** Lakes in basins of `MountainHeights` with the seed 513, each below the lowest pass out of its basin. */
export const LAKES: readonly LakeOptions[] = [
  { longitude: 0.5118, latitude: 46.5789, radius: 2000, level: 1516 },
  { longitude: 0.4226, latitude: 46.8356, radius: 7500, level: 434 },
  { longitude: 0.6261, latitude: 46.6842, radius: 2150, level: 1066 },
  { longitude: 0.8607, latitude: 46.6672, radius: 2750, level: 192 }
]
