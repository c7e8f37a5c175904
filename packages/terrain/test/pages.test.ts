import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera } from 'three'
import type { Renderer } from 'three/webgpu'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { HeightPages } from '../src/pages/HeightPages'
import { PageBaker } from '../src/pages/PageBaker'
import { PagedTiles } from '../src/pages/PagedTiles'
import type { PageSource } from '../src/pages/PageSource'
import { DEFAULTS } from '../src/TerrainOptions'
import type { Tile } from '../src/tiles/Tile'
import { TileTree } from '../src/tiles/TileTree'
import { viewerOf, type Viewer } from '../src/tiles/cpu/viewer'

const earth = Ellipsoid.WGS84
const RESOLUTION = 4
const HIGHEST = 4000

/** Pages that were drawn: of which tile, where, and the first of their heights. */
const drawn: { tile: Tile; slot: number; first: number }[] = []
vi.spyOn(PageBaker.prototype, 'bake').mockImplementation((_, tile, slot, heights) => {
  drawn.push({ tile, slot, first: heights![0] })
})
beforeEach(() => {
  drawn.length = 0
})
afterEach(() => void vi.useRealTimers())

const rendererOf = () => ({ isRenderer: true, info: { frame: 0 } })
const asRenderer = (renderer: ReturnType<typeof rendererOf>) => renderer as unknown as Renderer

/** Heights from a function, on a sea floor as far as `sampleAt` knows. */
const sourceOf = (loadHeights: PageSource['loadHeights']): PageSource => ({
  lowest: -500,
  highest: HIGHEST,
  variation: distance => Math.min(distance, HIGHEST + 500),
  sampleAt: (_, target) => Object.assign(target, { height: -500 }),
  loadHeights
})

const flat = (side: number, height: number): Float32Array =>
  new Float32Array(side ** 2).fill(height)

const pagesOf = (source: PageSource): { pages: HeightPages; tree: TileTree } => ({
  pages: new HeightPages(source, earth, { ...DEFAULTS, resolution: RESOLUTION, pageMemory: 1 }),
  tree: new TileTree(earth, source, 12, 1.5)
})

/** Lets promises that are settled go on. */
const settle = (): Promise<void> => new Promise(resolve => setTimeout(resolve))

it('draws whole faces anew when their heights arrive, however late', async () => {
  const arrivals: (() => void)[] = []
  const signals: AbortSignal[] = []
  const { pages, tree } = pagesOf(
    sourceOf(({ side }, signal) => {
      signals.push(signal)
      return new Promise(resolve => arrivals.push(() => resolve(flat(side, 700))))
    })
  )
  const renderer = asRenderer(rendererOf())
  for (let selection = 0; selection < 200; selection++) {
    pages.begin(renderer, tree.roots, selection)
    pages.load([], selection, 1)
  }
  expect(drawn.map(({ first }) => first)).toEqual(Array(6).fill(0))
  expect(signals.map(({ aborted }) => aborted)).toEqual(Array(6).fill(false))
  for (const root of tree.roots) root.lastDrawn = 200
  expect(pages.isFlat(200)).toBe(true)

  for (const arrive of arrivals) arrive()
  await settle()
  for (let selection = 200; selection < 203; selection++) {
    pages.begin(renderer, tree.roots, selection)
  }
  expect(drawn.slice(6).map(({ first }) => first)).toEqual(Array(6).fill(700))
  expect(drawn.slice(6).map(({ slot }) => slot)).toEqual(drawn.slice(0, 6).map(({ slot }) => slot))
  expect(tree.roots.every(({ slot, fade }) => slot >= 0 && fade === 0)).toBe(true)
  expect(pages.isFlat(200)).toBe(false)
  expect(pages.isStuck).toBe(true)
})

it('asks for the heights of a whole face again when they failed', async () => {
  let isBroken = true
  const { pages, tree } = pagesOf(
    sourceOf(({ side }) => {
      if (isBroken) throw new Error('no network')
      return flat(side, 700)
    })
  )
  vi.useFakeTimers()
  const renderer = asRenderer(rendererOf())
  pages.begin(renderer, tree.roots, 0)
  isBroken = false
  vi.advanceTimersByTime(4999)
  pages.begin(renderer, tree.roots, 500)
  expect(drawn.length).toBe(6)
  vi.advanceTimersByTime(1)
  pages.begin(renderer, tree.roots, 501)
  expect(drawn.slice(6).map(({ first }) => first)).toEqual(Array(6).fill(700))
})

it('tells who draws on demand each time that another drawing would show more, and no more once it is full', async () => {
  let arrive: (() => void)[] = []
  let failures = 0
  const source = sourceOf(({ side, level }) => {
    if (level === 1 && failures++ === 0) return Promise.reject(new Error('no network'))
    return new Promise(resolve => arrive.push(() => resolve(flat(side, 700))))
  })
  const renderer = rendererOf()
  const viewer = viewerAt(0, 2e6)
  let asked = 1
  const few = { ...DEFAULTS, resolution: RESOLUTION }
  const tiles = new PagedTiles(source, earth, few, () => void asked++)
  vi.useFakeTimers()
  /** Draws as long as it is asked for. */
  const draw = async (): Promise<number> => {
    let frames = 0
    for (; asked > 0 && frames < 1000; frames++) {
      asked = 0
      renderer.info.frame++
      tiles.update(asRenderer(renderer), viewer)
      await vi.advanceTimersByTimeAsync(0)
    }
    return frames
  }
  for (let round = 0; round < 50 && !(tiles.isFull && arrive.length === 0); round++) {
    expect(await draw()).toBeLessThan(200)
    const there = arrive
    arrive = []
    for (const each of there) each()
    await vi.advanceTimersByTimeAsync(there.length > 0 ? 0 : 5000)
  }
  expect(failures).toBeGreaterThan(1)
  expect(tiles.isFull).toBe(true)
  await draw()
  expect(asked).toBe(0)
  await vi.advanceTimersByTimeAsync(60_000)
  expect(asked).toBe(0)
})

it('bounds tiles by the heights of pages, not by what is known when the tile is made', () => {
  const source = sourceOf(({ side }) => {
    const heights = flat(side, 2800)
    heights[side] = 3000
    return heights
  })
  const { pages, tree } = pagesOf(source)
  pages.begin(asRenderer(rendererOf()), tree.roots, 0)
  let [tile] = tree.roots
  while (tile.level < 12) {
    const { lowest, highest } = tile
    const children = tile.split(earth, source)
    // Until a page is there: that of the coarser tile is drawn.
    for (const child of children) expect(child).toMatchObject({ lowest, highest })
    pages.load(children, 0, 4)
    for (const child of children) {
      expect(child.lowest).toBeLessThanOrEqual(2800)
      expect(child.highest).toBeGreaterThanOrEqual(3000)
    }
    tile = children[0]
  }
  expect(tile.lowest).toBeGreaterThan(1000)
  expect(tile.lowest).toBeLessThan(2800)
  expect(tile.highest).toBeGreaterThan(3000)
  expect(tile.highest).toBeLessThanOrEqual(HIGHEST)
})

it('bounds a tile by its page even if the source states other bounds', () => {
  const { pages, tree } = pagesOf(sourceOf(({ side }) => flat(side, 2 * HIGHEST)))
  pages.begin(asRenderer(rendererOf()), tree.roots, 0)
  expect(tree.roots[0].highest).toBe(2 * HIGHEST)
  expect(tree.roots[0].lowest).toBeLessThan(tree.roots[0].highest)
})

it('asks for what the next frame draws while it draws this one', async () => {
  const asked: number[] = []
  const { pages, tree } = pagesOf(
    sourceOf(({ side, level }) => {
      if (level > 0) asked.push(level)
      return level > 0 ? Promise.resolve(flat(side, 700)) : flat(side, 700)
    })
  )
  const renderer = asRenderer(rendererOf())
  const load = (tiles: readonly Tile[], selection: number): number => {
    pages.begin(renderer, tree.roots, selection)
    return pages.load(tiles, selection, 1)
  }
  load([], 0)
  const tiles = tree.roots[0].split(earth, tree.source)
  // Both are asked for, and neither is there.
  expect(load(tiles.slice(0, 2), 1)).toBe(0)
  expect(asked).toHaveLength(2)
  await settle()
  // The first is drawn, and the last two are asked for beside it.
  expect(load(tiles.slice(0, 1).concat(tiles.slice(2)), 2)).toBe(1)
  expect(asked).toHaveLength(4)
  await settle()
  // One that is there and not drawn is the last that is looked at: those after it wait.
  expect(load([tiles[1], tiles[2], ...tree.roots[1].split(earth, tree.source)], 3)).toBe(1)
  expect(asked).toHaveLength(4)
})

it.each([
  ['a promise of nothing', () => Promise.resolve(undefined), 'got undefined'],
  ['a promise of null', () => Promise.resolve(null), 'got null'],
  ['nothing', () => undefined, 'got undefined'],
  ['an array', (side: number) => Array.from({ length: side ** 2 }, () => 7), 'got [7, 7'],
  ['numbers of 64 bits', (side: number) => new Float64Array(side ** 2), 'Float64Array'],
  ['too few', (side: number) => new Float32Array(side), 'got 11'],
  ['a promise of too few', (side: number) => Promise.resolve(new Float32Array(side)), 'got 11']
])('fails if heights are %s, until it is disposed of', async (_, answer, got) => {
  let isWrong = true
  const { pages, tree } = pagesOf(
    sourceOf(({ side }) => (isWrong ? (answer(side) as never) : flat(side, 700)))
  )
  const renderer = asRenderer(rendererOf())
  const begin = (): unknown => pages.begin(renderer, tree.roots, 0)
  begin()
  await settle()
  expect(begin).toThrow('Terrain: source.loadHeights must give a Float32Array of 121 heights, got')
  expect(begin).toThrow(got)
  isWrong = false
  pages.dispose()
  drawn.length = 0
  begin()
  expect(drawn.map(({ first }) => first)).toEqual(Array(6).fill(700))
})

/** Viewer of a camera that looks at the horizon. */
function viewerAt(longitude: number, clearance: number): Viewer {
  const position = earth.geodeticToECEF({ longitude, latitude: 47, height: clearance })
  const camera = new PerspectiveCamera(60, 1.6, 1, 1e8)
  camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, new Matrix4()))
  camera.position.copy(position)
  camera.updateMatrixWorld()
  return viewerOf(camera, position, clearance, -500, new Matrix4(), earth, 0)
}

/** Heights that fail from a level on, and those that all come. */
const failing: PageSource['loadHeights'] = ({ side, level }) =>
  level > 9 ? Promise.reject(new Error('no data')) : flat(side, 700)
const complete: PageSource['loadHeights'] = ({ side }) => flat(side, 700)

it.each([
  ['heights fail', failing, 100],
  ['there is no room', complete, 1e-6]
])(
  'draws few pages in a frame, and fades them in, once no more come: %s',
  async (_, load, pageMemory) => {
    const tiles = new PagedTiles(sourceOf(load), earth, {
      ...DEFAULTS,
      resolution: RESOLUTION,
      detail: 1.5,
      pageMemory
    })
    const renderer = rendererOf()
    const update = async (viewer: Viewer): Promise<number> => {
      drawn.length = 0
      renderer.info.frame++
      tiles.update(asRenderer(renderer), viewer)
      await settle()
      return drawn.length
    }
    const here = viewerAt(0, 500)
    // Whole faces, and 32 times as many as later until no more come.
    expect(await update(here)).toBe(6 + 32)
    for (let frame = 0; frame < 100; frame++) await update(here)
    expect(tiles.isFull).toBe(false)
    expect(tiles.selection.lag).toBeGreaterThan(0)

    const there = viewerAt(0.05, 500)
    let count = 0
    const fades = new Set<number>()
    for (let frame = 0; frame < 40; frame++) {
      const pages = await update(there)
      expect(pages).toBeLessThanOrEqual(1)
      count += pages
      for (const { fade, slot } of tiles.selection.tiles) if (slot >= 0) fades.add(fade)
    }
    expect(count).toBeGreaterThan(0)
    expect(fades.size).toBeGreaterThan(2)
  }
)
