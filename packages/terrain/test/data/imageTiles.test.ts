import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { ImageTiles, type ImageTilesOptions } from '../../src/data/ImageTiles'
import type { Pixels } from '../../src/data/loadPixels'
import type { PageRequest } from '../../src/pages/PageSource'
import { degreesOf, pageAt, pageOf, partsOf } from './tiles'

const SIZE = 32
const never = new AbortController().signal
type Load = (z: number, x: number, y: number) => Pixels | null

/** Colour of a place: east in red, north in green [°]. */
const colorOf = (longitude: number, latitude: number): [number, number, number] => [
  128 + 100 * Math.sin((longitude * Math.PI) / 180),
  128 + 1.3 * latitude,
  60
]

/** Picture of a tile, a function of its places. */
function picture(scheme: 'mercator' | 'geographic', z: number, x: number, y: number): Pixels {
  const data = new Uint8ClampedArray(4 * SIZE ** 2)
  const isMercator = scheme === 'mercator'
  for (let i = 0; i < SIZE ** 2; i++) {
    const column = (x + ((i % SIZE) + 0.5) / SIZE) / ((isMercator ? 1 : 2) * 2 ** z)
    const row = (y + (Math.floor(i / SIZE) + 0.5) / SIZE) / 2 ** z
    const mercator = (Math.atan(Math.sinh(Math.PI * (1 - 2 * row))) * 180) / Math.PI
    const latitude = isMercator ? mercator : 90 - 180 * row
    data.set([...colorOf(column * 360 - 180, latitude), 255], 4 * i)
  }
  return { width: SIZE, height: SIZE, data }
}

/** Picture of one colour. */
const plain = (red: number, alpha = 255): Pixels => ({
  width: SIZE,
  height: SIZE,
  data: Uint8ClampedArray.from({ length: 4 * SIZE ** 2 }, (_, i) => [red, 0, 0, alpha][i % 4])
})

function tilesOf(load: Load, options: ImageTilesOptions = {}) {
  const asked: string[] = []
  const tiles = new ImageTiles('{z}/{x}/{y}', {
    size: SIZE,
    maxZoom: 4,
    retries: 0,
    ...options,
    async loadPixels(url) {
      asked.push(url)
      await Promise.resolve()
      return load(...partsOf(url))
    }
  })
  return { tiles, asked }
}

async function colorsOf(tiles: ImageTiles, request: PageRequest): Promise<Uint8ClampedArray> {
  await tiles.loadImage(request, never).catch(() => undefined)
  return tiles.imageOf(request).colors
}

const reds = (colors: Uint8ClampedArray): Set<number> =>
  new Set(colors.filter((_, i) => i % 4 === 0))

describe.each(['mercator', 'geographic'] as const)('pictures of a %s map', scheme => {
  const { tiles } = tilesOf((z, x, y) => picture(scheme, z, x, y), { scheme })

  it('have the colours of their places', async () => {
    await fc.assert(
      fc.asyncProperty(
        fc.double({ min: -179, max: 179, noNaN: true }),
        fc.double({ min: -78, max: 78, noNaN: true }),
        fc.integer({ min: 3, max: 9 }),
        async (longitude, latitude, level) => {
          const request = pageAt(longitude, latitude, level)
          const colors = await colorsOf(tiles, request)
          for (const [i, place] of degreesOf(request).entries()) {
            // Beyond, the last row of Web Mercator goes on.
            if (Math.abs(place.latitude) > 80) continue
            const expected = colorOf(place.longitude, place.latitude)
            for (const [n, value] of expected.entries()) {
              expect(Math.abs(colors[4 * i + n] - value)).toBeLessThan(level < 5 ? 6 : 2)
            }
            expect(colors[4 * i + 3]).toBe(255)
          }
        }
      ),
      { numRuns: 40 }
    )
  })

  it('agree along the edges of pages', async () => {
    const extent = 2 ** -5
    const west = pageOf(0, 5, extent, 5 * extent)
    const east = pageOf(0, 5, 3 * extent, 5 * extent)
    const [a, b] = [await colorsOf(tiles, west), await colorsOf(tiles, east)]
    const { side } = west
    for (let row = 0; row < side; row++) {
      const [left, right] = [4 * (row * side + side - 2), 4 * (row * side + 1)]
      expect(Math.abs(a[left] - b[right])).toBeLessThanOrEqual(1)
    }
  })
})

describe('what is missing', () => {
  const request = pageAt(10.3, 47.2, 7)
  const byLevel: Load = z => plain(50 * z)

  it('is transparent until something arrives', () => {
    const { colors, isWhole } = tilesOf(byLevel).tiles.imageOf(request)
    expect(isWhole).toBe(false)
    expect(colors.every(value => value === 0)).toBe(true)
  })

  it('shows the coarser tile, and is not asked for again', async () => {
    for (const bad of [null, { width: 2, height: 2, data: [] }, plain(9, 0)]) {
      const { tiles, asked } = tilesOf(z => (z === 4 ? bad : plain(50 * z)))
      expect(reds(await colorsOf(tiles, request))).toEqual(new Set([150]))
      expect(tiles.imageOf(request).isWhole).toBe(true)
      const count = asked.length
      await tiles.loadImage(request, never)
      expect(asked.length).toBe(count)
    }
  })

  it('shows the coarser tile where it is transparent', async () => {
    const half = plain(200)
    const data = Uint8ClampedArray.from(half.data, (value, i) =>
      i % 4 === 3 && (i >> 2) % SIZE < SIZE / 2 ? 0 : value
    )
    const { tiles } = tilesOf(z => (z === 4 ? { ...half, data } : plain(50 * z)))
    expect(reds(await colorsOf(tiles, pageAt(10.3, 47.2, 5)))).toEqual(new Set([150, 200]))
  })

  it('is asked for again after a failure, and shows what is there meanwhile', async () => {
    let isDown = true
    const { tiles } = tilesOf(z => {
      if (z === 4 && isDown) throw new Error('no network')
      return plain(50 * z)
    })
    await tiles.loadImage(pageAt(10.3, 47.2, 1), never)
    await expect(tiles.loadImage(request, never)).rejects.toThrow('no network')
    const { colors, isWhole } = tiles.imageOf(request)
    expect(isWhole).toBe(false)
    expect([...reds(colors)].every(red => red < 200)).toBe(true)
    isDown = false
    expect(reds(await colorsOf(tiles, request))).toEqual(new Set([200]))
  })

  it('is given up with its page', async () => {
    const { tiles } = tilesOf(byLevel)
    const abort = new AbortController()
    const loading = tiles.loadImage(request, abort.signal)
    abort.abort()
    await expect(loading).rejects.toThrow('abort')
    expect(tiles.tiles).toEqual({ count: 0, loading: 0, absent: 0, bytes: 0 })
  })
})

it('keeps to its memory', async () => {
  const { tiles } = tilesOf(z => plain(50 * z), { maxZoom: 7, memory: 0.2 })
  for (let i = 0; i < 40; i++) await colorsOf(tiles, pageAt(9 * i - 180, 40, 9))
  expect(tiles.tiles.bytes).toBeLessThanOrEqual(2e5)
  tiles.dispose()
  expect(tiles.tiles).toEqual({ count: 0, loading: 0, absent: 0, bytes: 0 })
})

it.each([
  ['scheme must be mercator or geographic', { scheme: 'polar' as never }],
  ['maxZoom must be in [0, 22], got 23', { maxZoom: 23 }],
  ["unknown option 'zoom'", { zoom: 1 } as ImageTilesOptions]
])('ImageTiles: %s', (message, options) => {
  expect(() => new ImageTiles('{z}/{x}/{y}', options)).toThrow(`ImageTiles: ${message}`)
})
