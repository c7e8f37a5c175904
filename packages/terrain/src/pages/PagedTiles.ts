import type { Renderer } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import type { Figure } from '../tiles/cpu/figure'
import type { Viewer } from '../tiles/cpu/viewer'
import type { TerrainHorizon } from '../tiles/TerrainHorizon'
import { noTiles, TileTree } from '../tiles/TileTree'
import { HeightPages } from './HeightPages'
import type { FixedOptions } from '../TerrainOptions'
import type { PageSource } from './PageSource'

/** Most tiles in a drawing. */
export const CAPACITY = 3000

/** Factor on the pages in a frame until the first picture is full. */
const FIRST_PAGES = 32

/** Frames in which a page takes the place of its parent's. */
const FADE_FRAMES = 10

/** Levels of missing detail from which on pages show without a fade: the camera has leapt. */
const LEAP = 4

/** Longest side of a cell of the finest tiles [m]. */
const FINEST_CELL = 1.2

/** Tiles that a viewer sees, and their pages: those that are missing are drawn, some in a frame. */
export class PagedTiles {
  readonly tree: TileTree
  readonly pages: HeightPages
  readonly selection = noTiles()
  /** Pages drawn in a frame. */
  pagesPerFrame = 1
  /** True if nothing is missing in the last selection, and all pages have faded in. */
  isFull = false
  /** Levels of detail that the last picture lacked once it was as full as it gets; null before the first. */
  #lastLag: number | null = null
  /** Frame of the renderer, and pages that may still be drawn in it. */
  #frame = -1
  #pagesLeft = 0

  readonly #horizon: TerrainHorizon | null

  /** @param onChange - See `Terrain.onChange`. */
  constructor(
    source: HeightSource | PageSource,
    figure: Figure,
    options: FixedOptions,
    onChange?: () => void
  ) {
    const { resolution, detail, horizon } = options
    const cells = (2 * figure.maximumRadius) / resolution / FINEST_CELL
    const finestLevel = Math.max(Math.ceil(Math.log2(cells)), 0)
    this.tree = new TileTree(figure, source, finestLevel, detail)
    this.pages = new HeightPages(source, figure, options, onChange)
    this.#horizon = horizon
  }

  /**
   * Chooses tiles for a viewer and draws pages.
   *
   * @param most - Pages to draw, default: what is left of `pagesPerFrame` in this frame. With `Infinity` pages show at once, without a fade.
   */
  update(renderer: Renderer, viewer: Viewer, most?: number): void {
    const { tree, pages, selection } = this
    const before = pages.drawn
    let fades = false
    if (pages.begin(renderer, tree.roots, tree.selections)) this.#lastLag = null
    const { frame } = renderer.info
    if (frame !== this.#frame) {
      this.#frame = frame
      this.#pagesLeft = this.pagesPerFrame * (this.#lastLag === null ? FIRST_PAGES : 1)
    }
    let left = most ?? this.#pagesLeft
    const isAtOnce = left === Infinity || this.#lastLag === null
    let drawn = 0
    do {
      tree.select(viewer, CAPACITY, selection)
      drawn = pages.load(selection.missing, tree.selections, left)
      left -= drawn
      const leaps = isAtOnce || selection.lag - (this.#lastLag ?? 0) >= LEAP
      for (const tile of selection.tiles) {
        // One that is there now is split in the next frame.
        fades ||= tile.slot >= 0 && tile.fade > 0
        tile.show(frame, leaps ? 1 : 1 / FADE_FRAMES)
      }
    } while (isAtOnce && drawn > 0)
    if (most === undefined) this.#pagesLeft = left
    this.isFull = selection.lag === 0 && !pages.isFlat(tree.selections)
    const isStuck = left > 0 && drawn === 0 && selection.missing.length > 0 && pages.isStuck
    if (selection.lag === 0 || isStuck) this.#lastLag = selection.lag
    // What is out of view makes room some drawings later.
    const waits = pages.refused > 0 && !pages.isStuck
    if (fades || waits || pages.drawn !== before) pages.onChange()
    if (!viewer.isOverGround) return
    this.#horizon?.cull(selection, viewer, tree.figure, pages.atlas.heightSide - 1)
  }

  /** Frees pages; the next update begins anew. */
  dispose(): void {
    this.pages.dispose()
    this.#lastLag = null
    this.isFull = false
  }
}
