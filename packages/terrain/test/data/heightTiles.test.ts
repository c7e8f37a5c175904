import fc from 'fast-check'
import { Atmosphere } from '@welkin/atmosphere'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import type { HeightTilesOptions } from '../../src/data/HeightTiles'
import type { Pixels } from '../../src/data/loadPixels'
import { TerrainRGBTiles, TerrariumTiles } from '../../src/data/TerrariumTiles'
import { Terrain } from '../../src/Terrain'
import { degreesOf, earth, hills, pageAt, pageOf, partsOf, terrariumTile } from './tiles'

const URL = '{z}/{x}/{y}'
const SIZE = 64
const never = new AbortController().signal
type Load = (z: number, x: number, y: number, signal: AbortSignal) => Pixels | null

/** Tiles of the hills, from a loader that may fail. */
function tilesOf(load: Load = terrariumTileOf, options: HeightTilesOptions = {}) {
  const asked: string[] = []
  const tiles = new TerrariumTiles(URL, {
    size: SIZE,
    maxZoom: 6,
    backOff: 0,
    retries: 1,
    ...options,
    async loadPixels(url, signal) {
      asked.push(url)
      await Promise.resolve()
      return load(...partsOf(url), signal)
    }
  })
  return { tiles, asked }
}

function terrariumTileOf(z: number, x: number, y: number): Pixels {
  return terrariumTile(z, x, y, hills, SIZE)
}

const sampleAt = (tiles: TerrariumTiles, longitude: number, latitude: number) =>
  tiles.sampleAt(earth.geodeticToECEF({ longitude, latitude }), {
    height: 0,
    gradient: new Vector3()
  })

describe('heights', () => {
  it('of a page are those of the data', async () => {
    const { tiles, asked } = tilesOf()
    const request = pageAt(10.3, 47.2, 7)
    const heights = await tiles.loadHeights(request, never)
    for (const [i, { longitude, latitude }] of degreesOf(request).entries()) {
      expect(Math.abs(heights[i] - hills(longitude, latitude))).toBeLessThan(1)
    }
    expect(asked.length).toBeGreaterThan(0)
    expect(asked.length).toBeLessThan(5)
    // All there: at once.
    expect(tiles.loadHeights(request, never)).toBeInstanceOf(Float32Array)
    // And the CPU finds the same.
    const { longitude, latitude } = degreesOf(request)[40]
    const { height, gradient } = sampleAt(tiles, longitude, latitude)
    expect(height).toBeCloseTo(heights[40], 2)
    const step = 1e-3
    const rise = sampleAt(tiles, longitude, latitude + step).height - height
    const way = earth
      .geodeticToECEF({ longitude, latitude: latitude + step })
      .sub(earth.geodeticToECEF({ longitude, latitude }))
    expect(gradient.dot(way)).toBeCloseTo(rise, 2)
    const east = earth
      .geodeticToECEF({ longitude: longitude + step, latitude })
      .sub(earth.geodeticToECEF({ longitude, latitude }))
    const rise2 = sampleAt(tiles, longitude + step, latitude).height - height
    expect(gradient.dot(east)).toBeCloseTo(rise2, 2)
  })

  it('raise the version of their terrain when they arrive, for what has asked before', async () => {
    const { tiles } = tilesOf()
    const terrain = new Terrain(new Atmosphere(), tiles, { resolution: 4 })
    const before = [terrain.version, terrain.heightAt(10.3, 47.2)]
    await tiles.loadHeights(pageAt(10.3, 47.2, 7), never)
    expect(terrain.version).toBeGreaterThan(before[0])
    expect(terrain.heightAt(10.3, 47.2)).not.toBe(before[1])
    terrain.dispose()
  })

  it('of neighbouring pages are the same along their edge', async () => {
    const { tiles } = tilesOf()
    const extent = 2 ** -5
    const west = pageOf(0, 5, extent, 5 * extent)
    const east = pageOf(0, 5, 3 * extent, 5 * extent)
    const [a, b] = [await tiles.loadHeights(west, never), await tiles.loadHeights(east, never)]
    const { side } = west
    for (let row = 0; row < side; row++) {
      expect(a[row * side + side - 2]).toBeCloseTo(b[row * side + 1], 3)
    }
  })

  it('are numbers all over the planet, and go on across the antimeridian and the poles', async () => {
    const { tiles } = tilesOf()
    for (let face = 0; face < 6; face++) {
      const heights = await tiles.loadHeights(pageOf(face, 0, 0, 0, 16), never)
      expect(heights.every(height => height > -1000 && height < 4000)).toBe(true)
    }
    for (const latitude of [12, 84.9, 85.2, -89.5]) {
      const [west, east] = [-1, 1].map(side => sampleAt(tiles, 180 + side * 1e-5, latitude).height)
      expect(Math.abs(west - east)).toBeLessThan(0.1)
    }
    const around = [0, 90, 180, 270].map(at => sampleAt(tiles, at, 89.9999).height)
    expect(Math.max(...around) - Math.min(...around)).toBeLessThan(0.1)
    for (let latitude = 84; latitude < 89; latitude += 0.01) {
      const rise =
        sampleAt(tiles, 33, latitude + 0.01).height - sampleAt(tiles, 33, latitude).height
      expect(Math.abs(rise)).toBeLessThan(60)
    }
  })

  it('are within the bounds that it states, at random places', async () => {
    // The hills' own bounds; their steepest slope is 0.0015.
    const { tiles } = tilesOf(undefined, { lowest: 500, highest: 2500, steepest: 0.002 })
    await tiles.loadHeights(pageAt(5.6, 45, 6), never)
    expect([tiles.lowest, tiles.highest]).toEqual([210, 2790])
    // All of one tile, whose edges are 0° and 11.25° east, 41° and 48.9° north.
    const anywhere = fc.tuple(
      fc.double({ min: 1, max: 10, noNaN: true }),
      fc.double({ min: 42, max: 48, noNaN: true })
    )
    fc.assert(
      fc.property(anywhere, anywhere, ([a, b], [c, d]) => {
        const [first, second] = [sampleAt(tiles, a, b).height, sampleAt(tiles, c, d).height]
        expect(first).toBeGreaterThan(tiles.lowest)
        expect(first).toBeLessThan(tiles.highest)
        expect(Math.abs(first - hills(a, b))).toBeLessThan(1)
        const distance = earth
          .geodeticToECEF({ longitude: a, latitude: b })
          .distanceTo(earth.geodeticToECEF({ longitude: c, latitude: d }))
        expect(Math.abs(first - second)).toBeLessThanOrEqual(tiles.variation(distance) + 0.01)
      }),
      { numRuns: 300 }
    )
    expect(tiles.variation(10)).toBeCloseTo(0.02)
    expect(tiles.variation(1e9)).toBeCloseTo(tiles.highest - tiles.lowest)
  })

  it('about a pole do not depend on what was loaded before', async () => {
    const options = { minZoom: 3 }
    // One page in each quarter about it.
    const [low, high] = [-3 / 64, 3 / 64]
    const pages = [low, high].flatMap(x => [low, high].map(y => pageOf(4, 6, x, y)))
    const alone = await tilesOf(undefined, options).tiles.loadHeights(pages[3], never)
    const { tiles } = tilesOf(undefined, options)
    for (const page of pages) await tiles.loadHeights(page, never)
    expect(tiles.loadHeights(pages[3], never)).toEqual(alone)
  })

  it('are decoded from Terrain-RGB, too', async () => {
    const tiles = new TerrainRGBTiles((z, x, y) => `${z}/${x}/${y}`, {
      lowest: undefined,
      size: 2,
      maxZoom: 0,
      // 123.4 m: 101,234 tenths over −10,000 m.
      loadPixels: async () => ({
        width: 2,
        height: 2,
        data: [1, 139, 114, 255, 1, 139, 114, 255, 1, 139, 114, 255, 1, 139, 114, 255]
      })
    })
    const heights = await tiles.loadHeights(pageAt(0, 0, 0), never)
    expect(heights.every(height => Math.abs(height - 123.4) < 1e-3)).toBe(true)
    expect(tiles.lowest).toBe(-9999 - 290)
  })
})

describe('a bad tile', () => {
  const place = pageAt(10.3, 47.2, 7)
  /** A tile of level 6 that is bad in some way, and good ones above it. */
  const bad =
    (make: () => Pixels | null): Load =>
    (z, x, y) =>
      z === 6 ? make() : terrariumTileOf(z, x, y)

  it.each<[string, () => Pixels | null]>([
    ['does not exist', () => null],
    ['has another size', () => terrariumTile(0, 0, 0, hills, 16)],
    ['is cut off', () => ({ width: SIZE, height: SIZE, data: new Uint8Array(100) })],
    ['has no data', () => terrariumTile(0, 0, 0, () => -32_768, SIZE)],
    ['is transparent', () => ({ width: SIZE, height: SIZE, data: new Uint8Array(4 * SIZE ** 2) })]
  ])('that %s shows its parent', async (_, make) => {
    const { tiles, asked } = tilesOf(bad(make))
    const heights = await tiles.loadHeights(place, never)
    for (const [i, { longitude, latitude }] of degreesOf(place).entries()) {
      expect(Math.abs(heights[i] - hills(longitude, latitude))).toBeLessThan(5)
    }
    // It is not asked for again.
    const count = asked.length
    await tiles.loadHeights(place, never)
    expect(asked.length).toBe(count)
    expect(sampleAt(tiles, 10.3, 47.2).height).toBeCloseTo(hills(10.3, 47.2), -1)
  })

  it('with holes shows its parent there alone', async () => {
    const { tiles } = tilesOf((z, x, y) => {
      const pixels = terrariumTileOf(z, x, y)
      const data = Uint8ClampedArray.from(pixels.data)
      if (z === 6) for (let i = 0; i < data.length; i += 40) data.set([0, 0, 0], i)
      return { ...pixels, data }
    })
    const heights = await tiles.loadHeights(place, never)
    for (const [i, { longitude, latitude }] of degreesOf(place).entries()) {
      expect(Math.abs(heights[i] - hills(longitude, latitude))).toBeLessThan(5)
    }
  })

  it('leaves sea level where there is none at all', async () => {
    const { tiles } = tilesOf(() => null)
    const heights = await tiles.loadHeights(place, never)
    expect(heights.every(height => height === 0)).toBe(true)
    expect(sampleAt(tiles, 0, 0).height).toBe(0)
  })

  it('whose server fails is tried again, and its page refused at last', async () => {
    let failures = 0
    let isDown = true
    const { tiles } = tilesOf(
      (z, x, y) => {
        if (!isDown) return terrariumTileOf(z, x, y)
        failures++
        throw new Error('503')
      },
      { retries: 2, minZoom: 0, maxZoom: 0 }
    )
    await expect(tiles.loadHeights(place, never)).rejects.toThrow('503')
    expect(failures).toBe(3)
    isDown = false
    const heights = await tiles.loadHeights(place, never)
    expect(heights.every(Number.isFinite)).toBe(true)
  })
})

describe('memory and flights', () => {
  it('keeps to its budget, and never lets go of the coarsest tile', async () => {
    const bytes = 4 * SIZE ** 2
    const { tiles, asked } = tilesOf(undefined, { memory: (10 * bytes) / 1e6 })
    await tiles.loadHeights(pageOf(0, 0, 0, 0), never)
    for (let longitude = -40; longitude < 40; longitude += 4) {
      await tiles.loadHeights(pageAt(longitude, 30, 7), never)
      expect(tiles.tiles.bytes).toBeLessThanOrEqual(10 * bytes)
    }
    const count = asked.filter(url => url === '0/0/0').length
    await tiles.loadHeights(pageOf(0, 0, 0, 0), never)
    expect(asked.filter(url => url === '0/0/0').length).toBe(count)
    tiles.dispose()
    expect(tiles.tiles).toEqual({ count: 0, loading: 0, absent: 0, bytes: 0 })
  })

  it('keeps to its budget where the coarsest level alone is larger', async () => {
    const bytes = 4 * SIZE ** 2
    const { tiles } = tilesOf(undefined, { minZoom: 3, memory: (10 * bytes) / 1e6 })
    for (let face = 0; face < 6; face++) await tiles.loadHeights(pageOf(face, 0, 0, 0), never)
    expect(tiles.tiles.bytes).toBe(10 * bytes)
  })

  it('gives up what a fast flight has left behind, and ends with what it came to', async () => {
    let open = 0
    let most = 0
    let aborted = 0
    const tiles = new TerrariumTiles(URL, {
      size: SIZE,
      maxZoom: 6,
      concurrency: 4,
      async loadPixels(url, signal) {
        most = Math.max(most, ++open)
        try {
          await new Promise((resolve, reject) => {
            const timer = setTimeout(resolve, 4)
            signal.addEventListener('abort', () => {
              clearTimeout(timer)
              aborted++
              reject(new Error('aborted'))
            })
          })
          return terrariumTileOf(...partsOf(url))
        } finally {
          open--
        }
      }
    })
    const settled: Promise<unknown>[] = []
    let abort = new AbortController()
    for (let i = 0; i < 60; i++) {
      abort.abort()
      abort = new AbortController()
      const page = pageAt(-170 + 5 * i, 20, 7)
      settled.push(Promise.resolve(tiles.loadHeights(page, abort.signal)).catch(() => null))
      if (i % 5 === 0) await new Promise(resolve => setTimeout(resolve, 2))
    }
    const results = await Promise.all(settled)
    expect(results.at(-1)).toBeInstanceOf(Float32Array)
    expect(results.filter(result => result === null).length).toBeGreaterThan(40)
    expect(most).toBeLessThanOrEqual(4)
    expect(aborted).toBeGreaterThan(0)
    expect(tiles.tiles.loading).toBe(0)
  })
})

it.each<[string, () => unknown]>([
  ['TerrariumTiles: minZoom must be in [0, 8]', () => new TerrariumTiles(URL, { minZoom: 9 })],
  ['TerrariumTiles: maxZoom must be in [0, 22]', () => new TerrariumTiles(URL, { maxZoom: 30 })],
  ['TerrariumTiles: size must be a whole', () => new TerrariumTiles(URL, { size: 2.5 })],
  ['TerrariumTiles: concurrency must', () => new TerrariumTiles(URL, { concurrency: 0 })],
  ['TerrariumTiles: retries must be in', () => new TerrariumTiles(URL, { retries: -1 })],
  ['TerrariumTiles: backOff must be', () => new TerrariumTiles(URL, { backOff: -1 })],
  ['TerrariumTiles: memory must be', () => new TerrariumTiles(URL, { memory: 0 })],
  ['TerrariumTiles: steepest must be', () => new TerrariumTiles(URL, { steepest: 0 })],
  ['TerrariumTiles: highest must be in', () => new TerrariumTiles(URL, { lowest: 1e4 })],
  ['TerrariumTiles: ellipsoid must be', () => new TerrariumTiles(URL, { ellipsoid: {} as never })],
  ["TerrainRGBTiles: unknown option 'zoom'", () => new TerrainRGBTiles(URL, { zoom: 1 } as never)],
  ['tileUrl: template must have {z} or {TileMatrix}', () => new TerrariumTiles('{x}/{y}')]
])('%s', (message, make) => {
  expect(make).toThrow(message)
})
