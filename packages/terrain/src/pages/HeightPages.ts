import { checkOwner } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import type { Renderer } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import { levelOf } from '../heights/sampleGround'
import type { FixedOptions } from '../TerrainOptions'
import type { Figure } from '../tiles/cpu/figure'
import type { Tile } from '../tiles/Tile'
import type { ImageLoader } from './ImageLoader'
import { PageAtlas } from './PageAtlas'
import { PageBaker, spacingOf } from './PageBaker'
import { PageLoads } from './PageLoads'
import { isPageSource, type PageSource } from './PageSource'

/** Selections without use after which a page may be evicted: several cameras draw in turn. */
const KEEP_FOR = 8

/** Steps of a page within which its heights may differ from the ground: coarse pages have means over about as many. */
const MARGIN_STEPS = 4

/** Heights of a page, with the least and the greatest of its ground. */
interface LoadedHeights {
  readonly heights: Float32Array
  readonly bounds: readonly [least: number, most: number]
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
  readonly #loads: PageLoads<LoadedHeights>
  /** Whole faces that are drawn flat until their heights arrive. */
  readonly #flat = new Set<Tile>()
  /** Answer of the source that is no heights. */
  #wrong: { answer: unknown } | null = null
  /** Pages drawn since the atlas was made, anew with their picture, too. */
  drawn = 0
  /** Pages in a row that there was no room for. */
  refused = 0

  /** @param onChange - Called between drawings when the next may show more: see `PageLoads`. */
  constructor(
    source: HeightSource | PageSource,
    figure: Figure,
    options: FixedOptions,
    readonly onChange: () => void = () => undefined
  ) {
    const { imagery } = options
    this.#loads = new PageLoads(onChange)
    this.#source = source
    this.atlas = new PageAtlas(options)
    this.#baker = new PageBaker(source, figure, this.atlas, options)
    this.#images = imagery?.makeLoader(tile => this.#baker.request(tile), onChange) ?? null
    this.#owners = Array.from({ length: this.atlas.capacity }, () => null)
  }

  /** Number of pages that tiles have. */
  get count(): number {
    return this.#owners.filter(Boolean).length
  }

  /**
   * Makes sure that whole faces have pages.
   *
   * @param selection - Number of the last selection.
   * @returns True if all pages were lost, with another renderer.
   * @throws If the pages belong to another renderer that has not been disposed of, or the source gave something else than heights.
   */
  begin(renderer: Renderer, roots: readonly Tile[], selection: number): boolean {
    if (this.#wrong !== null) {
      const rule = `source.loadHeights must give a Float32Array of ${this.#length} heights`
      fail('Terrain', rule, this.#wrong.answer)
    }
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
    this.#images?.update(selection, (tile, colors) => {
      this.#baker.bakeImage(renderer, tile, tile.slot, colors)
      this.drawn++
    })
    return isNew
  }

  /** True if missing pages will not come: their heights fail, or all pages of the atlas are in use. */
  get isStuck(): boolean {
    if (this.refused > 0) return this.refused > KEEP_FOR
    return this.#loads.open + (this.#images?.loads.open ?? 0) === 0
  }

  /** True if a whole face in the last selection is still flat. */
  isFlat(selection: number): boolean {
    return [...this.#flat].some(({ lastDrawn }) => lastDrawn === selection)
  }

  /** Draws a whole face: flat until its heights arrive. */
  #drawRoot(root: Tile, selection: number): void {
    const heights = this.#heightsOf(root, selection)
    const isNew = root.slot < 0
    const slot = isNew ? this.#place(selection) : root.slot
    const colors = isNew ? this.#images?.colorsOf(root, selection, false) : undefined
    if (colors !== undefined) this.#baker.bakeImage(this.#renderer!, root, slot, colors)
    if (heights !== undefined) {
      this.#draw(root, heights, slot)
      this.#flat.delete(root)
    } else if (isNew) {
      this.#bake(root, new Float32Array(this.#length).fill(levelOf(this.#source)), slot)
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
      const heights = this.#heightsOf(tile, selection)
      if (count >= most) {
        // What takes time is asked for a frame ahead.
        if (heights !== undefined || this.#loads.isFull) break
        continue
      }
      if (heights === undefined) continue
      const colors = this.#images?.colorsOf(tile, selection)
      if (this.#images !== null && colors === undefined) continue
      const slot = this.#place(selection)
      // All pages are in use: the ground stays as coarse as it is.
      if (slot < 0) {
        this.refused++
        break
      }
      this.refused = 0
      this.#draw(tile, heights, slot)
      if (colors !== undefined) this.#baker.bakeImage(this.#renderer!, tile, slot, colors)
      count++
    }
    if (count > 0) this.#baker.flush(this.#renderer!)
    this.#loads.abandon(selection)
    return count
  }

  #draw(tile: Tile, loaded: LoadedHeights | null, slot: number): void {
    this.#bake(tile, loaded && loaded.heights, slot)
    this.#loads.delete(tile)
    if (loaded === null) return
    const { lowest, highest } = this.#source
    const spacing = spacingOf(tile, this.#baker.figure, this.atlas.surfaceSide - 1)
    const margin = this.#source.variation(MARGIN_STEPS * spacing)
    const [least, most] = loaded.bounds
    tile.lowest = Math.min(Math.max(least - margin, lowest), least)
    tile.highest = Math.max(Math.min(most + margin, highest), most)
  }

  #bake(tile: Tile, heights: Float32Array | null, slot: number): void {
    const owner = this.#owners[slot]
    if (owner !== null) owner.slot = -1
    this.#owners[slot] = tile
    tile.slot = slot
    tile.fade = 1
    this.drawn++
    this.#baker.bake(this.#renderer!, tile, slot, heights)
  }

  /** Heights to draw a page with: null for those of a function, undefined while there are none. */
  #heightsOf(tile: Tile, selection: number): LoadedHeights | null | undefined {
    const source = this.#source
    if (!isPageSource(source)) return null
    const known = this.#loads.get(tile, selection)
    if (known !== undefined || this.#loads.isFull) return known?.value
    return this.#loads.begin(tile, selection, signal => {
      const heights = source.loadHeights(this.#baker.request(tile), signal)
      if (heights instanceof Float32Array) return this.#checked(heights)
      return Promise.resolve<unknown>(heights).then(answer => {
        signal.throwIfAborted()
        return this.#checked(answer)
      })
    }).value
  }

  /** @throws If they cannot be drawn. */
  #checked(answer: unknown): LoadedHeights {
    const heights = answer as Float32Array
    const length = answer instanceof Float32Array ? heights.length : answer
    const more = Number(length) - this.#length
    if (more !== 0 && more !== this.atlas.heightSide ** 2) this.#wrong = { answer: length }
    else {
      const bounds = boundsOf(heights.subarray(0, this.#length))
      const sky = boundsOf(heights.subarray(this.#length))
      // Caught where they were asked for, which is done again later.
      if (bounds.every(Number.isFinite) && !sky.some(Number.isNaN)) return { heights, bounds }
    }
    throw new Error()
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
    this.#loads.clear()
    this.#flat.clear()
    this.#images?.loads.clear()
    for (const [slot, owner] of this.#owners.entries()) {
      if (owner !== null) owner.slot = -1
      this.#owners[slot] = null
    }
    this.drawn = 0
  }

  /** Frees textures and pipelines; the next drawing begins anew. */
  dispose(): void {
    this.clear()
    this.#renderer = null
    this.#wrong = null
    this.atlas.dispose()
    this.#baker.dispose()
  }
}

/** Least and greatest height; NaN if one among them is not finite. */
function boundsOf(heights: Float32Array): [number, number] {
  let [least, most, zero] = [Infinity, -Infinity, 0]
  // `Math.min` of each takes five times as long.
  for (let i = 0; i < heights.length; i++) {
    const height = heights[i]
    if (height < least) least = height
    if (height > most) most = height
    // NaN from the first on that is not finite.
    zero += height - height
  }
  return [least + zero, most + zero]
}
