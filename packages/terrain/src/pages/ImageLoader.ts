import { fail } from '@welkin/geo'
import type { Tile } from '../tiles/Tile'
import { PageLoads, type PageLoad } from './PageLoads'
import type { PageRequest } from './PageSource'

/** Colours of a page. */
export interface PageImage {
  /** RGBA of 8 bits, sRGB, row by row, four times `side`² of them; alpha 0 where there is no picture. */
  readonly colors: Uint8ClampedArray
  /** True if no better ones can be loaded. */
  readonly isWhole: boolean
}

/** Methods of `PageImages` that a loader calls. */
export interface LoadedImages {
  imageOf(request: PageRequest): PageImage
  loadImage(request: PageRequest, signal: AbortSignal): Promise<void>
}

/** Selections that a page waits for its picture; then it is drawn with what has arrived. */
const PATIENCE = 30

/** Selections that a page counts as seen for after the last that it was in. */
const SEEN_FOR = 60

/** Most pages that are drawn anew in a selection. */
const MOST_REDRAWN = 2

/** Pictures of pages: each is loaded before its page is drawn if it comes soon, else after. */
export class ImageLoader {
  readonly #images: LoadedImages
  readonly #requestOf: (tile: Tile) => PageRequest
  readonly loads: PageLoads<void>

  /** @param onChange - See `PageLoads`. */
  constructor(images: LoadedImages, requestOf: (tile: Tile) => PageRequest, onChange: () => void) {
    this.#images = images
    this.#requestOf = requestOf
    this.loads = new PageLoads(onChange)
  }

  /**
   * Colours to draw a new page with; undefined while waiting for better ones pays.
   *
   * @param isPatient - False for pages that must be drawn now.
   * @throws If the source gives something else than colours.
   */
  colorsOf(tile: Tile, selection: number, isPatient = true): Uint8ClampedArray | undefined {
    const known = this.loads.get(tile, selection)
    const waits =
      known === undefined
        ? this.loads.isFull
        : known.state === 'loading' && selection - known.first <= PATIENCE
    if (waits && isPatient) return undefined
    const { colors, isWhole } = this.#imageOf(tile)
    if (isWhole) this.loads.delete(tile)
    else if (known === undefined) {
      this.#load(tile, selection)
      if (isPatient) return undefined
    }
    return colors
  }

  #imageOf(tile: Tile) {
    const request = this.#requestOf(tile)
    const image = this.#images.imageOf(request)
    const length = 4 * request.side ** 2
    if (!(image?.colors instanceof Uint8ClampedArray) || image.colors.length !== length) {
      fail('Terrain', `imagery.imageOf must give ${length} bytes of colours`, image?.colors?.length)
    }
    return image
  }

  #load(tile: Tile, selection: number): PageLoad<void> {
    return this.loads.begin(tile, selection, signal =>
      this.#images.loadImage(this.#requestOf(tile), signal)
    )
  }

  /**
   * Redraws pages whose colours have become better since they were drawn.
   *
   * @param redraw - Draws the colours of a page of the atlas.
   */
  update(selection: number, redraw: (tile: Tile, colors: Uint8ClampedArray) => void): void {
    let redrawn = 0
    for (const tile of this.loads.tiles) {
      if (tile.slot < 0 || selection - tile.lastDrawn > SEEN_FOR) continue
      const { state } = this.loads.get(tile, selection) ?? this.#load(tile, selection)
      if (state !== 'there' || ++redrawn > MOST_REDRAWN) continue
      this.loads.delete(tile)
      redraw(tile, this.#imageOf(tile).colors)
    }
    this.loads.abandon(selection)
  }
}
