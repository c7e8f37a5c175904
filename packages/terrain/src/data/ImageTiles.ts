import type { Vector3 } from 'three'
import { withDefaults } from '@welkin/atmosphere'
import { fail } from '@welkin/geo'
import type { PageImage } from '../pages/ImageLoader'
import { PageImages } from '../pages/PageImages'
import type { PageRequest } from '../pages/PageSource'
import { geographicPlace, geographicY, type GeographicPlace } from './geographic'
import { mercatorX, mercatorY, tileKey } from './mercator'
import { pagePlaces, type PagePlaces } from './pagePlaces'
import {
  pictureReader,
  TILE_DEFAULTS,
  TilesAbout,
  TileStore,
  type HeldTile,
  type TileCounts,
  type TileOptions
} from './TileStore'
import type { TileUrl } from './tileUrl'

/** Options of {@link ImageTiles}. */
export interface ImageTilesOptions extends TileOptions {
  /**
   * Map projection of the tiles: `'mercator'`, the default, is Web Mercator, one tile at level 0; `'geographic'` has longitude and latitude for
   * columns and rows, two tiles at level 0.
   */
  scheme?: 'mercator' | 'geographic'
}

const DEFAULTS: Required<ImageTilesOptions> = { ...TILE_DEFAULTS, scheme: 'mercator' }

/** Colours of a tile, RGBA of 8 bits. */
interface ImageTile extends HeldTile {
  readonly data: Uint8ClampedArray
}

const place: GeographicPlace = { longitude: 0, latitude: 0 }

/** Offsets of the four pixels about a place, each in its tile. */
const pixelPlaces = new Uint32Array(4)

/**
 * Imagery of the ground in tiles of XYZ, TMS or WMTS servers, loaded as they are needed.
 *
 * ```ts
 * const imagery = new ImageTiles('https://example.org/{z}/{x}/{y}.jpg', { maxZoom: 17, attribution: 'Who took them' })
 * scene.add(new Terrain(atmosphere, heights, { imagery }))
 * ```
 *
 * Until a tile arrives, and where it fails, is corrupt or does not exist, the coarser one is shown. Towards the poles the last row of a Web
 * Mercator map is repeated.
 */
export class ImageTiles extends PageImages {
  /** Line that names the data's source. */
  override readonly attribution: string
  readonly #options: Required<ImageTilesOptions>
  readonly #store: TileStore<ImageTile>
  /** Tile that was found last. */
  #lastZ = -1
  #lastX = 0
  #lastY = 0
  #last: Uint8ClampedArray | undefined

  /**
   * @param url - Template as of `tileUrl`, or a function.
   * @throws If the template lacks a name, or an option is unknown or out of its range.
   */
  constructor(url: string | TileUrl, options: ImageTilesOptions = {}) {
    super()
    const where = 'ImageTiles'
    const all = withDefaults(where, DEFAULTS, options)
    if (all.scheme !== 'mercator' && all.scheme !== 'geographic') {
      fail(where, 'scheme must be mercator or geographic', all.scheme)
    }
    this.#options = all
    this.attribution = all.attribution
    const wide = all.scheme === 'mercator' ? 1 : 2
    this.#store = new TileStore(where, url, all, wide, 4, pictureReader(all, decoded))
  }

  /** Counts up whenever a picture has arrived. */
  get version(): number {
    return this.#store.version
  }

  /** Tiles in memory, requests under way, tiles that are not there, and memory of the tiles [bytes]. */
  get tiles(): TileCounts {
    return this.#store.tiles
  }

  imageOf(request: PageRequest): PageImage {
    const { side } = request
    const z = this.#store.levelOf(request.spacing)
    const places = this.#placesOf(request)
    const { x, y } = places
    let isWhole = true
    this.#lastZ = -1
    for (const key of this.#keysOf(z, places)) {
      this.#store.get(key)
      isWhole &&= this.#store.isSettled(key)
    }
    const colors = new Uint8ClampedArray(4 * side * side)
    for (let i = 0; i < side * side; i++) {
      const row = Math.min(Math.max(y[i], 0), 1)
      // A missing tile, or a hole in it, shows the coarser one.
      for (let level = z; level >= this.#options.minZoom; level--) {
        if (this.#sample(level, x[i], row, colors, 4 * i)) break
      }
    }
    return { colors, isWhole }
  }

  async loadImage(request: PageRequest, signal: AbortSignal): Promise<void> {
    const keys = [...this.#keysOf(this.#store.levelOf(request.spacing), this.#placesOf(request))]
    await Promise.all(keys.map(key => this.#store.obtain(key, signal, () => undefined)))
  }

  /** Gives up all requests and lets the tiles go. */
  dispose(): void {
    this.#store.clear()
  }

  #placesOf(request: PageRequest): PagePlaces {
    const { radii } = this.#options.ellipsoid
    const rowOf = this.#options.scheme === 'mercator' ? mercatorY : geographicY
    const project = (positionECEF: Vector3, target: { x: number; y: number }): void => {
      geographicPlace(positionECEF, radii, place)
      target.x = mercatorX(place.longitude)
      target.y = rowOf(place.latitude)
    }
    return pagePlaces(request, project, 1)
  }

  #keysOf(z: number, { x, y }: PagePlaces): Set<number> {
    const about = new TilesAbout(1 / this.#options.size, this.#store.wide)
    for (let i = 0; i < x.length; i++) about.add(z, x[i], Math.min(Math.max(y[i], 0), 1))
    return about.keys
  }

  /**
   * Colour of a place on a level, linear between pixels.
   *
   * @returns False if the tile is missing, or has a hole there.
   */
  #sample(z: number, x: number, y: number, target: Uint8ClampedArray, at: number): boolean {
    const { size } = this.#options
    const scale = size * 2 ** z
    const column = x * this.#store.wide * scale - 0.5
    const row = Math.min(Math.max(y * scale - 0.5, 0), scale - 1)
    const [left, top] = [Math.floor(column), Math.floor(row)]
    const [right, down] = [column - left, row - top]
    const below = Math.min(top + 1, scale - 1)
    const a = this.#pixel(z, left, top, 0)
    const b = this.#pixel(z, left + 1, top, 1)
    const c = this.#pixel(z, left, below, 2)
    const d = this.#pixel(z, left + 1, below, 3)
    if (!(a && b && c && d)) return false
    const [w, v] = [(1 - right) * (1 - down), right * (1 - down)]
    const [u, t] = [(1 - right) * down, right * down]
    const [i, j, k, l] = pixelPlaces
    for (let n = 0; n < 3; n++) {
      target[at + n] = w * a[i + n] + v * b[j + n] + u * c[k + n] + t * d[l + n]
    }
    target[at + 3] = 255
    return true
  }

  /** Pixels of the tile that has a given pixel, whose offset is left in `pixelPlaces`; undefined if the tile is missing. */
  #pixel(z: number, column: number, row: number, n: number): Uint8ClampedArray | undefined {
    const { size } = this.#options
    const x = Math.floor(column / size)
    const y = Math.floor(row / size)
    if (z !== this.#lastZ || x !== this.#lastX || y !== this.#lastY) {
      this.#lastZ = z
      this.#lastX = x
      this.#lastY = y
      this.#last = this.#store.peek(tileKey(z, x, y, this.#store.wide))?.data
    }
    const place = 4 * ((row - y * size) * size + column - x * size)
    pixelPlaces[n] = place
    return this.#last !== undefined && this.#last[place + 3] > 0 ? this.#last : undefined
  }
}

/** Pixels of a tile; null if all are transparent. */
function decoded(data: ArrayLike<number>): ImageTile | null {
  let holes = 0
  for (let i = 3; i < data.length; i += 4) if (data[i] === 0) holes++
  return 4 * holes < data.length
    ? { data: Uint8ClampedArray.from(data), hasHoles: holes > 0 }
    : null
}
