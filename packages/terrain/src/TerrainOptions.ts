import type { Camera } from 'three'
import { checkRange } from '@welkin/atmosphere'
import { checkFinite, fail } from '@welkin/geo'
import type { HeightSource } from './heights/HeightSource'
import type { PageImages } from './pages/PageImages'
import type { GroundMaps } from './surface/maps/GroundMaps'
import type { GroundMask } from './surface/maps/GroundMask'
import type { farTiles } from './tiles/FarTiles'
import type { TerrainHorizon } from './tiles/TerrainHorizon'
import type { PageSource } from './pages/PageSource'

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
  /** Draws tiles far away with less code, `farTiles`: less time from 10 km up, for two shaders more; null, the default, draws all with one. */
  far?: typeof farTiles | null
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

/** Options that may change later, and their defaults. */
const SETTINGS = {
  imageAlbedo: 1,
  seaLevel: 0,
  windSpeed: 7,
  waveTime: 0,
  shadowDistance: 3000,
  camera: null,
  pagesPerFrame: 1
}

export type TerrainSetting = keyof typeof SETTINGS
export const SETTING_NAMES = Object.keys(SETTINGS) as TerrainSetting[]

/** Options that cannot change later. */
export type FixedOptions = Required<Omit<TerrainOptions, TerrainSetting>>

/** Options that are left out. */
export const DEFAULTS: Required<TerrainOptions> = {
  ...SETTINGS,
  resolution: 12,
  detail: 1.2,
  imagery: null,
  maps: null,
  mask: null,
  horizon: null,
  far: null,
  pageMemory: 190
}

/** Options that are objects: a property that each has, and what it must be. */
const OBJECTS = [
  ['imagery', 'makeLoader', 'ImageTiles, PageImages'],
  ['maps', 'layers', 'GroundMaps'],
  ['mask', 'materials', 'a GroundMask'],
  ['horizon', 'cull', 'a TerrainHorizon'],
  ['far', 'call', 'farTiles']
] as const

/** @throws If it is no source of heights. */
export function checkSource(where: string, source: HeightSource | PageSource): void {
  const given = Object(source) as Record<string, unknown>
  const methods = ['sampleAt', 'variation', 'loadHeights' in given ? 'loadHeights' : 'sample']
  if (methods.some(name => typeof given[name] !== 'function')) {
    fail(where, 'source must be a HeightSource', source)
  }
  checkFinite(where, 'source.lowest', source.lowest)
  checkFinite(where, 'source.highest', source.highest)
}

/** @throws If an option that cannot change later is out of its range. */
export function checkFixed(where: string, options: FixedOptions): void {
  const { resolution, detail, pageMemory } = options
  checkRange(where, 'resolution', resolution, 4, 128)
  if (resolution % 2 !== 0) fail(where, 'resolution must be even', resolution)
  checkRange(where, 'detail', detail, 1.2, 4)
  checkRange(where, 'pageMemory', pageMemory, 4, 1000)
  for (const [name, property, kind] of OBJECTS) {
    const value: object | null = options[name]
    if (value !== null && !(property in Object(value))) {
      fail(where, `${name} must be ${kind} or null`, value)
    }
  }
}
