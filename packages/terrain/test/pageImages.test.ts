import { Ellipsoid } from '@welkin/geo'
import type { Renderer } from 'three/webgpu'
import { expect, it, vi } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { HeightPages } from '../src/pages/HeightPages'
import { PageBaker } from '../src/pages/PageBaker'
import { PageImages } from '../src/pages/PageImages'
import { DEFAULTS } from '../src/TerrainOptions'
import type { Tile } from '../src/tiles/Tile'
import { TileTree } from '../src/tiles/TileTree'

const earth = Ellipsoid.WGS84
const source = new MountainHeights()
const renderer = { isRenderer: true, info: { frame: 0 } } as unknown as Renderer

/** Brightness of the picture that a tile was last drawn with. */
const shown = new Map<Tile, number>()
vi.spyOn(PageBaker.prototype, 'bake').mockImplementation(() => undefined)
vi.spyOn(PageBaker.prototype, 'flush').mockImplementation(() => undefined)
vi.spyOn(PageBaker.prototype, 'bakeImage').mockImplementation((_, tile, _slot, colors) => {
  shown.set(tile, colors[0])
})

/** Pictures from a server: 1 where nothing has come yet, else 2. */
class Pictures extends PageImages {
  readonly #there = new Set<string>()
  #waiting: (() => void)[] = []
  isDown = false

  imageOf({ side, level, x, y }: Parameters<PageImages['imageOf']>[0]) {
    const isWhole = this.#there.has(`${level} ${x} ${y}`)
    return { colors: new Uint8ClampedArray(4 * side ** 2).fill(isWhole ? 2 : 1), isWhole }
  }

  loadImage({ level, x, y }: Parameters<PageImages['imageOf']>[0], signal: AbortSignal) {
    if (this.isDown) return Promise.reject(new Error('no network'))
    return new Promise<void>((resolve, reject) => {
      signal.addEventListener('abort', () => reject(new Error('given up')))
      this.#waiting.push(() => {
        if (!signal.aborted) this.#there.add(`${level} ${x} ${y}`)
        resolve()
      })
    })
  }

  arrive(): void {
    for (const arrive of this.#waiting) arrive()
    this.#waiting = []
  }
}

function setUp() {
  shown.clear()
  const imagery = new Pictures()
  const tree = new TileTree(earth, source, 12, 1.5)
  const pages = new HeightPages(source, earth, {
    ...DEFAULTS,
    resolution: 4,
    pageMemory: 4,
    imagery
  })
  let selection = 0
  /** Some frames with tiles in view. */
  const look = async (tiles: readonly Tile[], frames: number): Promise<void> => {
    for (const end = selection + frames; selection < end; selection++) {
      for (const tile of tiles) tile.lastDrawn = selection
      pages.begin(renderer, tree.roots, selection)
      const missing = tiles.filter(({ slot }) => slot < 0)
      pages.load(missing, selection, Infinity)
      await Promise.resolve()
    }
  }
  const tiles = tree.roots.flatMap(root => root.split(earth, source))
  return { imagery, pages, tiles, look }
}

it('draws all pages without pictures while a server is down', async () => {
  vi.useFakeTimers()
  const { imagery, tiles, look } = setUp()
  imagery.isDown = true
  await look(tiles, 20)
  expect(tiles.length).toBe(24)
  expect(tiles.filter(({ slot }) => slot < 0)).toEqual([])
  imagery.isDown = false
  await vi.advanceTimersByTimeAsync(5000)
  await look(tiles, 1)
  for (let round = 0; round < 20; round++) {
    imagery.arrive()
    await look(tiles, 20)
  }
  expect(new Set(tiles.map(tile => shown.get(tile)))).toEqual(new Set([2]))
  vi.useRealTimers()
})

it('gives a page that was drawn before its picture came, and was out of view then, the picture when it is seen again', async () => {
  const { imagery, tiles, look } = setUp()
  const [tile] = tiles
  await look([tile], 40)
  expect(tile.slot).toBeGreaterThanOrEqual(0)
  expect(shown.get(tile)).toBe(1)
  await look([], 100)
  imagery.arrive()
  await look([], 400)
  await look([tile], 5)
  imagery.arrive()
  await look([tile], 5)
  expect(shown.get(tile)).toBe(2)
})
