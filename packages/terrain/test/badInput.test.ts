import { Atmosphere } from '@welkin/atmosphere'
import { MountainHeights, Terrain, terrainView } from '@welkin/terrain'
import { Vector3 } from 'three'
import { expect, it } from 'vitest'

const atmosphere = new Atmosphere()
const heights = new MountainHeights()
/** Value of a type that the compiler would not let pass. */
const wrong = (value: unknown): never => value as never
const bounds = { sampleAt: () => null, variation: () => 0 }
const make = (options = {}) => new Terrain(atmosphere, heights, options)
const terrain = make({ resolution: 4 })

const cases: [message: string, call: () => unknown][] = [
  ['Terrain: atmosphere must be an Atmosphere', () => new Terrain(wrong({}), heights)],
  [
    'Terrain.heightAt: a flat world has no longitudes',
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
