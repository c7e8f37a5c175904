import { afterEach, expect, it, vi } from 'vitest'
import { ImageTiles } from '../../src/data/ImageTiles'
import type { Pixels } from '../../src/data/loadPixels'
import { QuantizedMeshTiles } from '../../src/data/QuantizedMeshTiles'
import { TerrariumTiles } from '../../src/data/TerrariumTiles'
import { hills, pageAt, partsOf, terrariumTile } from './tiles'

const never = new AbortController().signal
afterEach(() => {
  vi.unstubAllGlobals()
  vi.restoreAllMocks()
})

/** Tiles of 64 pixels from a function, asked for pages all over the place; and what the user was told. */
async function told(load: (z: number, x: number, y: number) => Pixels | null) {
  const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined)
  const tiles = new TerrariumTiles('{z}/{x}/{y}', {
    size: 64,
    maxZoom: 6,
    loadPixels: url => Promise.resolve(load(...partsOf(url)))
  })
  for (const longitude of [-150, -60, 10, 100]) {
    await Promise.resolve(tiles.loadHeights(pageAt(longitude, 40, 6), never))
  }
  return { lines: warn.mock.calls.map(([line]) => String(line)), tiles }
}

it('are told of once, with the size that they have, if all have another', async () => {
  const { lines, tiles } = await told((z, x, y) => terrariumTile(z, x, y, hills, 128))
  expect(lines.length).toBe(1)
  expect(lines[0]).toMatch(
    /^TerrariumTiles: no tile so far, \d+\/\d+\/\d+ has 128 × 128 pixels, size is 64$/
  )
  expect(tiles.tiles.absent).toBeGreaterThan(8)
})

it('are told of once, with an address, if a server refuses all', async () => {
  const { lines } = await told(() => null)
  expect(lines.length).toBe(1)
  expect(lines[0]).toMatch(/ is missing, refused or corrupt$/)
})

it('are not told of where others are there', async () => {
  const { lines, tiles } = await told((z, x, y) =>
    z > 3 ? null : terrariumTile(z, x, y, hills, 64)
  )
  expect(tiles.tiles.absent).toBeGreaterThan(4)
  expect(tiles.tiles.count).toBeGreaterThan(0)
  expect(lines).toEqual([])
})

it('are told of by imagery, too', async () => {
  const warn = vi.spyOn(console, 'warn').mockImplementation(() => undefined)
  const imagery = new ImageTiles('{z}/{x}/{y}', {
    size: 64,
    loadPixels: () =>
      Promise.resolve({ width: 32, height: 32, data: new Uint8Array(4 * 32 * 32).fill(255) })
  })
  for (const longitude of [-150, -60, 10, 100])
    await imagery.loadImage(pageAt(longitude, 40, 8), never)
  expect(warn.mock.calls.map(([line]) => String(line))).toEqual([
    expect.stringMatching(/^ImageTiles: no tile so far, .* has 32 × 32 pixels, size is 64$/)
  ])
})

it('of quantised meshes fail if a server hangs', async () => {
  const late = new AbortController()
  const timeout = vi.spyOn(AbortSignal, 'timeout').mockReturnValue(late.signal)
  let requests = 0
  vi.stubGlobal(
    'fetch',
    (_: string, { signal, headers }: { signal: AbortSignal; headers: { Accept: string } }) =>
      new Promise((_resolve, reject) => {
        expect(headers.Accept).toContain('quantized-mesh')
        requests++
        signal.addEventListener('abort', () => reject(new Error('given up')))
      })
  )
  const meshes = new QuantizedMeshTiles('{z}/{x}/{y}', () => ({}) as never, { retries: 0 })
  const heights = Promise.resolve(meshes.loadHeights(pageAt(10, 40, 4), never))
  await Promise.resolve()
  expect(requests).toBeGreaterThan(0)
  late.abort()
  await expect(heights).rejects.toThrow('given up')
  expect(timeout).toHaveBeenCalledWith(30_000)
}, 1000)
