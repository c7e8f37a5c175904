import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import type { Renderer } from 'three/webgpu'
import { afterAll, beforeAll, expect, it, vi } from 'vitest'
import { HeightPages } from '../src/pages/HeightPages'
import { PageBaker } from '../src/pages/PageBaker'
import { PagedTiles } from '../src/pages/PagedTiles'
import type { PageSource } from '../src/pages/PageSource'
import type { Tile } from '../src/tiles/Tile'
import { DEFAULTS } from '../src/TerrainOptions'
import { viewerOf, type Viewer } from '../src/tiles/cpu/viewer'
import { randomNumbers } from './randomNumbers'

beforeAll(() => void vi.useFakeTimers())
afterAll(() => void vi.useRealTimers())

const earth = Ellipsoid.WGS84
const options = { ...DEFAULTS, resolution: 4, detail: 1.5 }

/** Tile and height that each place of the atlas was last drawn with. */
const atlas = new Map<number, { tile: Tile; height: number }>()
vi.spyOn(PageBaker.prototype, 'bake').mockImplementation((_, tile, slot, heights) => {
  atlas.set(slot, { tile, height: heights![0] })
})

/** Height that tells a place: of neighbouring tiles others, whatever their level. */
const heightAt = ({ x, y, z }: Vector3): number => 1000 + 900 * Math.sin((x + 2 * y + 3 * z) / 1e6)

/** Loader whose answers come after a random number of frames, some of them never, some as failures. */
class SlowLoader implements PageSource {
  readonly lowest = 0
  readonly highest = 2000
  /** Requests that have neither been answered nor given up. */
  readonly open = new Set<() => void>()
  aborted = 0
  #frame = 0
  readonly #due = new Map<number, (() => void)[]>()

  constructor(
    readonly random: () => number,
    readonly longest: number
  ) {}

  variation = (): number => 2000
  sampleAt: PageSource['sampleAt'] = (position, target) =>
    Object.assign(target, { height: heightAt(position) })

  loadHeights: PageSource['loadHeights'] = ({ side, placeOf }, signal) => {
    const middle = (side - 1) / 2
    const height = heightAt(placeOf(middle, middle, new Vector3()))
    return new Promise((resolve, reject) => {
      const settle = (): void => {
        this.open.delete(settle)
        if (this.random() < 0.1) reject(new Error('no data'))
        // Late answers to requests that were given up come, too: some loaders cannot be stopped.
        else resolve(new Float32Array(side ** 2).fill(height))
      }
      this.open.add(settle)
      signal.addEventListener('abort', () => {
        this.aborted++
        this.open.delete(settle)
      })
      const frame = this.#frame + Math.floor(this.random() ** 3 * this.longest)
      this.#due.set(frame, [...(this.#due.get(frame) ?? []), settle])
    })
  }

  /** Answers what is due. */
  async nextFrame(): Promise<void> {
    for (const settle of this.#due.get(this.#frame) ?? []) settle()
    this.#due.delete(this.#frame++)
    await vi.advanceTimersByTimeAsync(17)
  }
}

const axes = new Matrix4()
const camera = new PerspectiveCamera(60, 1.6, 1, 1e8)

function viewerAt(
  longitude: number,
  latitude: number,
  height: number,
  turn: { heading: number; pitch: number }
): Viewer {
  const position = earth.geodeticToECEF({ longitude, latitude, height: 2000 + height })
  camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, axes))
  camera.rotateY(turn.heading)
  camera.rotateX(turn.pitch)
  camera.position.copy(position)
  camera.updateMatrixWorld()
  return viewerOf(camera, position, height, 0, axes.identity(), earth, 0)
}

/** Flight that goes somewhere else every so many frames: 2 m to 20,000 km high, and up to 20 of its heights far in a frame. */
function flight(random: () => number, leg: number): (frame: number) => Viewer {
  let [longitude, latitude, power, climb, speed] = [0, 0, 3, 0, 0]
  const turn = { heading: 0, pitch: 0 }
  return frame => {
    if (frame % leg === 0) {
      climb = ((0.3 + 7 * random() - power) / leg) * 1.2
      speed = 20 * random() ** 3
      Object.assign(turn, { heading: 7 * random(), pitch: -1.5 * random() })
      // A leap to anywhere, or back to where it began.
      if (random() < 0.2) [longitude, latitude] = [360 * random() - 180, 170 * random() - 85]
      else if (random() < 0.3) [longitude, latitude, power] = [0, 0, 4]
    }
    power = Math.min(Math.max(power + climb, 0.3), 7.3)
    const way = Math.min((speed * 10 ** power) / 111_000, 5)
    longitude = ((longitude + way * Math.sin(turn.heading) + 540) % 360) - 180
    latitude = Math.min(Math.max(latitude + way * Math.cos(turn.heading), -89.9), 89.9)
    return viewerAt(longitude, latitude, 10 ** power, turn)
  }
}

const tilesOf = (tile: Tile): number =>
  1 + (tile.children ?? []).reduce((sum, child) => sum + tilesOf(child), 0)

/** @throws If a page is drawn that belongs to another tile, or has the heights of another one. */
function checkPages({ selection }: PagedTiles): number {
  let area = 0
  const check = (tile: Tile): void => {
    const page = atlas.get(tile.slot)
    if (page?.tile !== tile) throw new Error(`a stale page is drawn at level ${tile.level}`)
    // Whole faces are drawn level until their heights come.
    const isLevel = tile.level === 0 && page.height === 0
    if (isLevel || Math.abs(page.height - heightAt(tile.center)) < 0.01) return
    throw new Error(`level ${tile.level} has the height ${page.height}`)
  }
  for (const tile of selection.tiles) {
    area += 4 * tile.extent ** 2
    if (tile.slot >= 0) check(tile)
    if (tile.slot < 0 || tile.fade > 0) if (tile.parent !== null) check(tile.parent)
  }
  return area
}

it('draws no stale page in fast flights, however late heights come, and ends with a full picture', async () => {
  atlas.clear()
  const random = randomNumbers(7)
  const loader = new SlowLoader(random, 90)
  const tiles = new PagedTiles(loader, earth, { ...options, pageMemory: 1e-6 })
  const renderer = { isRenderer: true, info: { frame: 0 } }
  const next = flight(random, 40)
  let viewer = next(0)
  /** Frames that show ground: from far above, looking ahead, there is none. */
  let shown = 0
  const update = async (): Promise<void> => {
    renderer.info.frame++
    tiles.update(renderer as unknown as Renderer, viewer)
    if (checkPages(tiles) > 0) shown++
    if (loader.open.size > 40) throw new Error(`${loader.open.size} requests wait`)
    await loader.nextFrame()
  }
  for (let frame = 1; frame < 800; frame++) {
    viewer = next(frame)
    await update()
  }
  expect(shown).toBeGreaterThan(500)
  expect(loader.aborted).toBeGreaterThan(20)
  // Pages were evicted.
  expect(tiles.pages.drawn).toBeGreaterThan(1.5 * tiles.pages.atlas.capacity)
  viewer = viewerAt(11, 47, 2e7, { heading: 0, pitch: -1.5 })
  for (let frame = 0; frame < 3000 && !tiles.isFull; frame++) await update()
  expect(tiles.isFull).toBe(true)
}, 60_000)

it('keeps its memory within bounds in half an hour of flying', async () => {
  atlas.clear()
  const random = randomNumbers(19)
  const loader = new SlowLoader(random, 2)
  const tiles = new PagedTiles(loader, earth, { ...options, pageMemory: 0.25 })
  const renderer = { isRenderer: true, info: { frame: 0 } }
  // A second in a frame: each comes to as much that is new as sixty would.
  const minutes = 30
  const next = flight(random, 20)
  const { capacity } = tiles.pages.atlas
  let most = 0
  for (let second = 0; second < 60 * minutes; second++) {
    renderer.info.frame++
    tiles.update(renderer as unknown as Renderer, next(second), 12)
    await loader.nextFrame()
    expect(tiles.pages.count).toBeLessThanOrEqual(capacity)
    expect(loader.open.size).toBeLessThan(20)
    if (second % 10 > 0) continue
    // Tiles with a page stay, with those above and beside them, and for four minutes what was seen.
    most = Math.max(
      most,
      tiles.tree.roots.reduce((sum, root) => sum + tilesOf(root), 0)
    )
  }
  expect(tiles.pages.drawn).toBeGreaterThan(2 * capacity)
  expect(most).toBeLessThan(5 * capacity)
  tiles.dispose()
  expect(tiles.pages.count).toBe(0)
}, 60_000)

it.each([200, 64, 20])(
  'keeps pages within %i MB, as many as a view needs where there is room',
  megabytes => {
    for (const resolution of [12, 16, 24]) {
      const { atlas: pages } = new HeightPages(new SlowLoader(Math.random, 1), earth, {
        ...DEFAULTS,
        resolution,
        pageMemory: megabytes
      })
      const { heights, surface } = pages
      const bytes = [heights, surface].reduce(
        (sum, { width, height }) => sum + 8 * width * height,
        0
      )
      expect(bytes).toBe(pages.bytes)
      expect(bytes).toBeLessThanOrEqual(1e6 * megabytes)
      if (megabytes > 20) expect(pages.capacity).toBeGreaterThan(1000)
      pages.dispose()
    }
  }
)
