import type { Camera } from 'three'
import { checkRange } from '@welkin/atmosphere'
import { checkFinite, fail } from '@welkin/geo'
import type { HeightSource } from './heights/HeightSource'
import type { PageImages } from './pages/PageImages'
import type { GroundMaps } from './surface/maps/GroundMaps'
import type { GroundMask } from './surface/maps/GroundMask'
import type { TerrainHorizon } from './tiles/TerrainHorizon'
import { isPageSource, type PageSource } from './pages/PageSource'

/** Options of `Terrain`. */
export interface TerrainOptions {
  /** Cells along a tile's edge, even, in [4, 128], default 12: 16 has finer ridges, for an eighth more time at eye height. */
  resolution?: number
  /** Distance at which a tile is split, in diagonals of it, in [1.2, 4], default 1.2: larger values have finer ridges, and more tiles by their square. */
  detail?: number
  /** Imagery of the ground, such as `ImageTiles`, in place of procedural colours; null, the default, for none. */
  imagery?: PageImages | null
  /** Reflectance of white in the imagery, ≥ 0, default 1 [–]: many pictures are brighter than what they show. */
  imageAlbedo?: number
  /** Texture maps of the ground's materials; null, the default, for procedural ones. */
  maps?: GroundMaps | null
  /** Mask of the ground's materials; null, the default, leaves them to height, slope and latitude. */
  mask?: GroundMask | null
  /** Horizon culling, `new TerrainHorizon()`: tiles that other ground hides are not drawn, for half a millisecond of the CPU; null, the default, for none. */
  horizon?: TerrainHorizon | null
  /** Surface of the sea above the ellipsoid, default 0 [m]; −Infinity for none. */
  seaLevel?: number
  /** Wind over the sea, in [0, 40], default 7 [m/s]: more of it has steeper waves, and a wider glint of the sun. */
  windSpeed?: number
  /** Time of the sea's waves, default 0 [s]: yours to advance. */
  waveTime?: number
  /** Distance within which ground out of view casts shadows into it, default 3,000 [m]. */
  shadowDistance?: number
  /** Camera that tiles are chosen for; null, the default, for each one that draws. */
  camera?: Camera | null
  /** Most memory of pages on the GPU, in [4, 1000], default 190 [MB]; room for 64 pages is taken at least. */
  pageMemory?: number
  /** Pages drawn in a frame, ≥ 1, default 1. */
  pagesPerFrame?: number
}

/** Options that may change later. */
export const SETTINGS = [
  'imageAlbedo',
  'seaLevel',
  'windSpeed',
  'waveTime',
  'shadowDistance',
  'camera',
  'pagesPerFrame'
] as const

/** Options that are left out. */
export const DEFAULTS: Required<TerrainOptions> = {
  resolution: 12,
  detail: 1.2,
  imagery: null,
  imageAlbedo: 1,
  maps: null,
  mask: null,
  horizon: null,
  seaLevel: 0,
  windSpeed: 7,
  waveTime: 0,
  shadowDistance: 3000,
  camera: null,
  pageMemory: 190,
  pagesPerFrame: 1
}

/** @throws If it is no source of heights. */
export function checkSource(where: string, source: HeightSource | PageSource): void {
  const isSource =
    typeof source?.sampleAt === 'function' &&
    typeof source.variation === 'function' &&
    (isPageSource(source) ? typeof source.loadHeights : typeof source.sample) === 'function'
  if (!isSource) fail(where, 'source must be a HeightSource', source)
  checkFinite(where, 'source.lowest', source.lowest)
  checkFinite(where, 'source.highest', source.highest)
}

/** @throws If an option that cannot change later is out of its range. */
export function checkFixed(
  where: string,
  { resolution, detail, pageMemory, imagery, maps, mask, horizon }: Required<TerrainOptions>
): void {
  checkRange(where, 'resolution', resolution, 4, 128)
  if (resolution % 2 !== 0) fail(where, 'resolution must be even', resolution)
  checkRange(where, 'detail', detail, 1.2, 4)
  checkRange(where, 'pageMemory', pageMemory, 4, 1000)
  if (maps !== null && !Array.isArray(maps?.layers))
    fail(where, 'maps must be GroundMaps or null', maps)
  if (mask !== null && !Array.isArray(mask?.materials))
    fail(where, 'mask must be a GroundMask or null', mask)
  if (horizon !== null && typeof horizon?.cull !== 'function')
    fail(where, 'horizon must be a TerrainHorizon or null', horizon)
  if (imagery === null) return
  const isImagery =
    typeof imagery?.imageOf === 'function' && typeof imagery.loadImage === 'function'
  if (!isImagery) fail(where, 'imagery must be ImageTiles, PageImages or null', imagery)
}
