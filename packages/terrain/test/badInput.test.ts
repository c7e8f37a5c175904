import { Atmosphere } from '@welkin/atmosphere'
import {
  GroundMask,
  GroundMaps,
  Lake,
  MountainHeights,
  Terrain,
  terrainView,
  type GroundMaskOptions
} from '@welkin/terrain'
import { Texture, Vector3 } from 'three'
import { expect, it } from 'vitest'

const atmosphere = new Atmosphere()
const heights = new MountainHeights()
/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never
const bounds = { sampleAt: () => null, variation: () => 0 }
const make = (options = {}) => new Terrain(atmosphere, heights, options)
const terrain = make({ resolution: 4 })
const albedo = new Texture()
const painted: GroundMaskOptions = { materials: ['sand'], west: 0, east: 1, south: 0, north: 1 }

const basin = { longitude: 8, latitude: 47, radius: 2000, level: 400 }

const cases: [message: string, call: () => unknown][] = [
  ["Lake: unknown option 'depth'", () => new Lake(terrain, wrong({ ...basin, depth: 1 }))],
  [
    'Lake: latitude must be in [-90, 90], got 91',
    () => new Lake(terrain, { ...basin, latitude: 91 })
  ],
  [
    'Lake: radius must be in [0, 100000], got 200000',
    () => new Lake(terrain, { ...basin, radius: 2e5 })
  ],
  [
    'Lake: level must be a finite number, got NaN',
    () => new Lake(terrain, { ...basin, level: NaN })
  ],
  [
    'Lake: needs a globe',
    () => new Lake(new Terrain(new Atmosphere({ flat: true }), heights, { resolution: 4 }), basin)
  ],
  ['Terrain: atmosphere must be an Atmosphere', () => new Terrain(wrong({}), heights)],
  [
    'Terrain.heightAt: use heightBelow in a flat world',
    () => new Terrain(new Atmosphere({ flat: true }), heights, { resolution: 4 }).heightAt(0, 0)
  ],
  ['Terrain: source must be a HeightSource', () => new Terrain(atmosphere, wrong({}))],
  ["Terrain: unknown option 'detial', did you mean 'detail'?", () => make({ detial: 2 })],
  ['Terrain: resolution must be in [4, 128], got 2', () => make({ resolution: 2 })],
  ['Terrain: resolution must be even, got 33', () => make({ resolution: 33 })],
  ['Terrain: detail must be in [1.2, 4], got 1', () => make({ detail: 1 })],
  ['Terrain: seaLevel must be in [-100000, 100000], got NaN', () => make({ seaLevel: NaN })],
  ['Terrain: imagery must be ImageTiles', () => make({ imagery: wrong({}) })],
  ['Terrain: imageAlbedo must be finite and ≥ 0, got -1', () => make({ imageAlbedo: -1 })],
  ['Terrain: shadowDistance must be finite and ≥ 0, got -1', () => make({ shadowDistance: -1 })],
  ['Terrain: pageMemory must be in [4, 1000], got 1', () => make({ pageMemory: 1 })],
  ['Terrain: pagesPerFrame must be in [1, 1000], got 0', () => make({ pagesPerFrame: 0 })],
  [
    'Terrain: source must be a HeightSource',
    () => new Terrain(atmosphere, wrong({ loadHeights: true, ...bounds }))
  ],
  ['Terrain: maps must be GroundMaps or null', () => make({ maps: wrong({}) })],
  ['Terrain: mask must be a GroundMask or null', () => make({ mask: wrong({}) })],
  ['Terrain: horizon must be a TerrainHorizon or null', () => make({ horizon: wrong({}) })],
  ['GroundMaps: at least one material needs maps', () => new GroundMaps({})],
  ['GroundMaps: materials are rock, scree', () => new GroundMaps(wrong({ lava: { albedo } }))],
  ['GroundMaps: rock.albedo must be a Texture', () => new GroundMaps({ rock: wrong({}) })],
  [
    'GroundMaps: sand.ao must be a Texture',
    () => new GroundMaps({ sand: wrong({ albedo, ao: 1 }) })
  ],
  ["GroundMaps: unknown option 'size'", () => new GroundMaps({ sand: wrong({ albedo, size: 1 }) })],
  ['GroundMaps: sand.side must be', () => new GroundMaps({ sand: { albedo, side: 0 } })],
  ['GroundMaps: sand.relief must be', () => new GroundMaps({ sand: { albedo, relief: 2 } })],
  [
    'GroundMaps: size must be a power of two',
    () => new GroundMaps({ sand: { albedo } }, { size: 100 })
  ],
  ['GroundMask: texture must be a Texture', () => new GroundMask(wrong(1), painted)],
  [
    'GroundMask: materials must be one to four',
    () => new GroundMask(albedo, { ...painted, materials: [] })
  ],
  [
    "GroundMask: materials must be 'rock', 'scree'",
    () => new GroundMask(albedo, { ...painted, materials: [wrong('lava')] })
  ],
  ['GroundMask: east must exceed west', () => new GroundMask(albedo, { ...painted, west: 2 })],
  [
    'GroundMask: north must be a finite number',
    () => new GroundMask(albedo, { ...painted, north: NaN })
  ],
  ['terrainView: view must be one of levels, tiles, pages', () => terrainView(wrong('rocks'))],
  ['Terrain: camera must be a Camera or null', () => (terrain.camera = wrong({}))],
  ['Terrain.heightAt: longitude must be a finite number, got NaN', () => terrain.heightAt(NaN, 0)],
  ['Terrain.heightAt: latitude must be in [-90, 90], got 91', () => terrain.heightAt(0, 91)],
  ['Terrain.normalAt: latitude must be in [-90, 90], got -91', () => terrain.normalAt(0, -91)],
  [
    'Terrain.heightBelow: position must have finite components',
    () => terrain.heightBelow(new Vector3(NaN, 0, 0))
  ],
  ['MountainHeights: relief must be', () => new MountainHeights({ relief: 0 })],
  ['MountainHeights: relief must be at most 20000', () => new MountainHeights({ relief: 3e4 })],
  ['MountainHeights: seed must be a whole number', () => new MountainHeights({ seed: 0.5 })],
  ["MountainHeights: unknown option 'sed'", () => new MountainHeights(wrong({ sed: 1 }))]
]

it.each(cases)('%s', (message, call) => {
  expect(call).toThrow(message)
})

it('changes all settings or none', () => {
  expect(() => terrain.set({ seaLevel: 5, shadowDistance: -1 })).toThrow('shadowDistance')
  expect(terrain.seaLevel).toBe(0)
})

it('answers with the sea where it covers the ground', () => {
  const deep = new Terrain(atmosphere, heights, { resolution: 4, seaLevel: 9e4 })
  expect(deep.heightAt(10, 20)).toBe(9e4)
  const up = atmosphere.ellipsoid.surfaceNormal(
    atmosphere.ellipsoid.geodeticToECEF({ longitude: 10, latitude: 20 })
  )
  expect(deep.normalAt(10, 20).distanceTo(up)).toBeLessThan(1e-12)
})
