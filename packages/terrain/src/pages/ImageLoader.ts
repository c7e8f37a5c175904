import { fail } from '@welkin/geo'
import type { Tile } from '../tiles/Tile'
import type { PageImages } from './PageImages'
import type { PageRequest } from './PageSource'

/** Selections that a page waits for its picture; then it is drawn with what has arrived. */
const PATIENCE = 30

/** Selections without a request after which loading pictures are given up. */
const WAIT_FOR = 60

/** Selections after which a picture that failed is asked for again. */
const RETRY_AFTER = 300

/** Most pictures that are waited for at once. */
const MOST_REQUESTS = 12

/** Most pages that are drawn anew in a selection. */
const MOST_REDRAWN = 2

/** A picture that is not whole. */
interface Loading {
  readonly abort: AbortController
  /** Selections that first and last asked for it. */
  readonly first: number
  wanted: number
  state: 'loading' | 'there' | 'failed'
  /** Selection at which it failed. */
  failed: number
}

/** Pictures of pages: each is loaded before its page is drawn if it comes soon, else after. */
export class ImageLoader {
  readonly #images: PageImages
  readonly #requestOf: (tile: Tile) => PageRequest
  readonly #loading = new Map<Tile, Loading>()

  constructor(images: PageImages, requestOf: (tile: Tile) => PageRequest) {
    this.#images = images
    this.#requestOf = requestOf
  }

  /**
   * Colours to draw a new page with; undefined while waiting for better ones pays.
   *
   * @param isPatient - False for pages that must be drawn now.
   * @throws If the source gives something else than colours.
   */
  colorsOf(tile: Tile, selection: number, isPatient = true): Uint8ClampedArray | undefined {
    const known = this.#loading.get(tile)
    if (known !== undefined) {
      known.wanted = selection
      const waits = known.state === 'loading' && selection - known.first <= PATIENCE
      if (waits && isPatient) return undefined
    } else if (this.#loading.size >= MOST_REQUESTS && isPatient) return undefined
    const request = this.#requestOf(tile)
    const { colors, isWhole } = this.#imageOf(request)
    if (isWhole) {
      this.#loading.delete(tile)
      return colors
    }
    if (known === undefined) {
      this.#load(tile, request, selection)
      if (isPatient) return undefined
    }
    return colors
  }

  #imageOf(request: PageRequest) {
    const image = this.#images.imageOf(request)
    const length = 4 * request.side ** 2
    if (!(image?.colors instanceof Uint8ClampedArray) || image.colors.length !== length) {
      fail('Terrain', `imagery.imageOf must give ${length} bytes of colours`, image?.colors?.length)
    }
    return image
  }

  #load(tile: Tile, request: PageRequest, selection: number): void {
    const abort = new AbortController()
    const loading: Loading = {
      abort,
      first: selection,
      wanted: selection,
      state: 'loading',
      failed: 0
    }
    this.#loading.set(tile, loading)
    const settle = (state: 'there' | 'failed') => (): void => {
      loading.state = state
      loading.failed = loading.wanted
    }
    this.#images.loadImage(request, abort.signal).then(settle('there'), settle('failed'))
  }

  /**
   * Redraws pages whose colours have become better since they were drawn.
   *
   * @param redraw - Draws the colours of a page of the atlas.
   */
  update(selection: number, redraw: (tile: Tile, colors: Uint8ClampedArray) => void): void {
    let redrawn = 0
    for (const [tile, loading] of this.#loading) {
      const isDrawn = tile.slot >= 0
      if (isDrawn && selection - tile.lastDrawn <= WAIT_FOR) loading.wanted = selection
      if (loading.state === 'there' && isDrawn) {
        if (++redrawn > MOST_REDRAWN) continue
        this.#loading.delete(tile)
        redraw(tile, this.#imageOf(this.#requestOf(tile)).colors)
      } else if (selection - loading.wanted > WAIT_FOR) {
        loading.abort.abort()
        this.#loading.delete(tile)
      } else if (loading.state === 'failed' && selection - loading.failed > RETRY_AFTER) {
        this.#loading.delete(tile)
        if (isDrawn) this.#load(tile, this.#requestOf(tile), selection)
      }
    }
  }

  /** True while pages wait for their pictures. */
  get isWaiting(): boolean {
    return [...this.#loading].some(([{ slot }]) => slot < 0)
  }

  /** Gives up all. */
  clear(): void {
    for (const { abort } of this.#loading.values()) abort.abort()
    this.#loading.clear()
  }
}
