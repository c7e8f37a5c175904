import { checkOwner } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import type { Renderer } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import type { Figure } from '../tiles/cpu/figure'
import type { TerrainHorizon } from '../tiles/TerrainHorizon'
import type { Tile } from '../tiles/Tile'
import { ImageLoader } from './ImageLoader'
import { PageAtlas } from './PageAtlas'
import { PageBaker, spacingOf } from './PageBaker'
import type { PageImages } from './PageImages'
import { isPageSource, type PageSource } from './PageSource'

/** Selections without use after which a page may be evicted: several cameras draw in turn. */
const KEEP_FOR = 8

/** Selections without a request after which loading heights are given up. */
const WAIT_FOR = 60

/** Selections after which heights that failed are asked for again. */
const RETRY_AFTER = 300

/** Most requests for heights at once. */
const MOST_REQUESTS = 12

/** Steps of a page within which its heights may differ from the ground: coarse pages have means over about as many. */
const MARGIN_STEPS = 4

/** Heights that were asked for. */
interface Loading {
  readonly abort: AbortController
  /** Selection that last asked for them. */
  wanted: number
  heights: Float32Array | null
}

/**
 * Pages of the ground: heights, slopes and patches of a tile, drawn once on the GPU, or loaded, and kept in a fixed atlas until others
 * need the room: the least recently used goes first.
 */
export class HeightPages {
  readonly atlas: PageAtlas
  readonly #source: HeightSource | PageSource
  readonly #baker: PageBaker
  readonly #images: ImageLoader | null
  #renderer: Renderer | null = null
  /** Tiles by the slot of their page. */
  readonly #owners: (Tile | null)[]
  readonly #loading = new Map<Tile, Loading>()
  /** Selections at which tiles' heights failed. */
  readonly #failures = new Map<Tile, number>()
  /** Whole faces that are drawn flat until their heights arrive. */
  readonly #flat = new Set<Tile>()
  #error: unknown = null
  /** Pages drawn since the atlas was made. */
  drawn = 0
  /** Pages in a row that there was no room for. */
  #refused = 0

  /**
   * @param resolution - Cells along a tile's edge.
   * @param bytes - See {@link PageAtlas}.
   */
  constructor(
    source: HeightSource | PageSource,
    figure: Figure,
    resolution: number,
    bytes: number,
    images: PageImages | null = null,
    horizon: TerrainHorizon | null = null
  ) {
    this.#source = source
    this.atlas = new PageAtlas(resolution, bytes, images !== null)
    this.#baker = new PageBaker(source, figure, this.atlas, resolution, horizon)
    this.#images =
      images === null ? null : new ImageLoader(images, tile => this.#baker.request(tile))
    this.#owners = Array.from({ length: this.atlas.capacity }, () => null)
  }

  /** Number of pages that tiles have. */
  get count(): number {
    return this.#owners.filter(owner => owner !== null).length
  }

  /**
   * Makes sure that whole faces have pages.
   *
   * @param selection - Number of the last selection.
   * @returns True if all pages were lost, with another renderer.
   * @throws If the pages belong to another renderer that has not been disposed of, or the source gave something else than heights.
   */
  begin(renderer: Renderer, roots: readonly Tile[], selection: number): boolean {
    if (this.#error !== null) throw this.#error
    const isNew = renderer !== this.#renderer
    if (isNew) {
      checkOwner('Terrain', this.#renderer, renderer)
      this.clear()
      this.#renderer = renderer
    }
    for (const root of roots) {
      if (root.slot < 0 || this.#flat.has(root)) this.#drawRoot(root, selection)
    }
    this.#baker.flush(renderer)
    this.#images?.update(selection, ({ slot }, colors) => {
      this.#baker.bakeImage(renderer, slot, colors)
    })
    return isNew
  }

  /** True if missing pages will not come: their heights fail, or all pages of the atlas are in use. */
  get isStuck(): boolean {
    if (this.#refused > 0) return this.#refused > KEEP_FOR
    return this.#loading.size === 0 && this.#images?.isWaiting !== true
  }

  /** True if a whole face in the last selection is still flat. */
  isFlat(selection: number): boolean {
    return [...this.#flat].some(({ lastDrawn }) => lastDrawn === selection)
  }

  /** Draws a whole face: flat until its heights arrive. */
  #drawRoot(root: Tile, selection: number): void {
    const heights = this.#heightsOf(root, selection)
    const slot = root.slot < 0 ? this.#place(selection) : root.slot
    const colors = root.slot < 0 ? this.#images?.colorsOf(root, selection, false) : undefined
    if (colors !== undefined) this.#baker.bakeImage(this.#renderer!, slot, colors)
    if (heights !== undefined) {
      this.#draw(root, heights, slot)
      this.#flat.delete(root)
    } else if (root.slot < 0) {
      const { lowest, highest } = this.#source
      const flat = new Float32Array(this.#length).fill(Math.min(Math.max(0, lowest), highest))
      this.#bake(root, flat, slot)
      this.#flat.add(root)
    }
    root.fade = 0
  }

  /** Number of a page's heights. */
  get #length(): number {
    return (this.atlas.surfaceSide + 2) ** 2
  }

  /**
   * Draws pages, or asks for their heights.
   *
   * @param tiles - Without pages, the most urgent first.
   * @param selection - Number of the selection that they are of.
   * @param most - Pages to draw.
   * @returns Number of pages drawn.
   */
  load(tiles: readonly Tile[], selection: number, most: number): number {
    let count = 0
    for (const tile of tiles) {
      if (count >= most) break
      const heights = this.#heightsOf(tile, selection)
      if (heights === undefined) continue
      const colors = this.#images?.colorsOf(tile, selection)
      if (this.#images !== null && colors === undefined) continue
      const slot = this.#place(selection)
      // All pages are in use: the ground stays as coarse as it is.
      if (slot < 0) {
        this.#refused++
        break
      }
      this.#refused = 0
      this.#draw(tile, heights, slot)
      if (colors !== undefined) this.#baker.bakeImage(this.#renderer!, slot, colors)
      count++
    }
    if (count > 0) this.#baker.flush(this.#renderer!)
    this.#abandon(selection)
    return count
  }

  #draw(tile: Tile, heights: Float32Array | null, slot: number): void {
    this.#bake(tile, heights, slot)
    this.#loading.delete(tile)
    if (heights === null) return
    const { lowest, highest } = this.#source
    const spacing = spacingOf(tile, this.#baker.figure, this.atlas.surfaceSide - 1)
    const margin = this.#source.variation(MARGIN_STEPS * spacing)
    const least = Math.min(...heights)
    const most = Math.max(...heights)
    tile.lowest = Math.min(Math.max(least - margin, lowest), least)
    tile.highest = Math.max(Math.min(most + margin, highest), most)
  }

  #forget(owner: Tile): void {
    owner.slot = -1
    owner.heights = null
  }

  #bake(tile: Tile, heights: Float32Array | null, slot: number): void {
    const owner = this.#owners[slot]
    if (owner !== null) this.#forget(owner)
    this.#owners[slot] = tile
    tile.slot = slot
    tile.fade = 1
    tile.heights = null
    this.drawn++
    this.#baker.bake(this.#renderer!, tile, slot, heights)
  }

  /** Heights to draw a page with: null for those of a function, undefined while there are none. */
  #heightsOf(tile: Tile, selection: number): Float32Array | null | undefined {
    const source = this.#source
    if (!isPageSource(source)) return null
    const known = this.#loading.get(tile)
    if (known !== undefined) {
      known.wanted = selection
      return known.heights ?? undefined
    }
    const failed = this.#failures.get(tile)
    if (failed !== undefined && selection - failed < RETRY_AFTER) return undefined
    if (this.#loading.size >= MOST_REQUESTS) return undefined
    this.#failures.delete(tile)
    const abort = new AbortController()
    const loading: Loading = { abort, wanted: selection, heights: null }
    this.#loading.set(tile, loading)
    const giveUp = (): void => {
      if (this.#loading.get(tile) !== loading) return
      this.#loading.delete(tile)
      this.#failures.set(tile, loading.wanted)
    }
    const finish = (answer: unknown): void => {
      if (this.#loading.get(tile) !== loading) return
      loading.heights = this.#checked(answer)
      if (loading.heights === null) giveUp()
    }
    try {
      const answer = source.loadHeights(this.#baker.request(tile), abort.signal)
      if (answer instanceof Float32Array) finish(answer)
      else Promise.resolve<unknown>(answer).then(finish, giveUp)
    } catch {
      giveUp()
    }
    return loading.heights ?? undefined
  }

  /** Heights that can be drawn; null if they cannot. */
  #checked(heights: unknown): Float32Array | null {
    const length = this.#length
    const isArray = heights instanceof Float32Array
    if (isArray && heights.length === length) return heights.every(Number.isFinite) ? heights : null
    const rule = `source.loadHeights must give a Float32Array of ${length} heights`
    try {
      fail('Terrain', rule, isArray ? heights.length : heights)
    } catch (error) {
      this.#error = error
    }
    return null
  }

  /** Gives up heights that nobody waits for, and forgets failures that no longer count. */
  #abandon(selection: number): void {
    for (const [tile, failed] of this.#failures) {
      if (selection - failed >= RETRY_AFTER) this.#failures.delete(tile)
    }
    for (const [tile, { wanted, abort }] of this.#loading) {
      if (selection - wanted <= WAIT_FOR) continue
      abort.abort()
      this.#loading.delete(tile)
    }
  }

  /** Slot for a page: a free one, or that of the least recently used tile; −1 if all are in use. */
  #place(selection: number): number {
    let oldest = selection - KEEP_FOR
    let place = -1
    for (const [slot, owner] of this.#owners.entries()) {
      if (owner === null) return slot
      if (owner.level > 0 && owner.lastDrawn < oldest) {
        oldest = owner.lastDrawn
        place = slot
      }
    }
    return place
  }

  /** Forgets all pages. */
  clear(): void {
    for (const { abort } of this.#loading.values()) abort.abort()
    this.#loading.clear()
    this.#failures.clear()
    this.#flat.clear()
    this.#images?.clear()
    for (const [slot, owner] of this.#owners.entries()) {
      if (owner !== null) this.#forget(owner)
      this.#owners[slot] = null
    }
    this.drawn = 0
  }

  /** Frees textures and pipelines; the next drawing begins anew. */
  dispose(): void {
    this.clear()
    this.#renderer = null
    this.#error = null
    this.atlas.dispose()
    this.#baker.dispose()
  }
}
