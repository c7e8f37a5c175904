import { checkRange } from '@welkin/atmosphere'
import { checkEllipsoid, checkNonNegative, checkPositive, Ellipsoid, fail } from '@welkin/geo'
import { loadPixels, type Pixels } from './loadPixels'
import { tileKey, tileOfKey } from './mercator'
import { TileCache } from './TileCache'
import { PermanentFailure, TileRequests } from './TileRequests'
import { tileUrl, type TileUrl } from './tileUrl'

/** Options of tiles that are loaded from a server. */
export interface TileOptions {
  /** Coarsest level that the server has, in [0, 8], default 0. */
  minZoom?: number
  /** Finest level that the server has, in [minZoom, 22], default 15. */
  maxZoom?: number
  /** Pixels along a tile's edge, default 256. */
  size?: number
  /** Most memory of decoded tiles, > 0, default 64 [MB]: the coarsest level stays if it takes no more than half of it. */
  memory?: number
  /** Most requests at once, ≥ 1, default 8. */
  concurrency?: number
  /** Times that a failed request is tried again, ≥ 0, default 3. */
  retries?: number
  /** Wait before the first of these, doubled each time, ≥ 0, default 0.5 [s]. */
  backOff?: number
  /** Line that names the data's source, default ''. */
  attribution?: string
  /** Ellipsoid of revolution that the tiles lie on, default WGS84. */
  ellipsoid?: Ellipsoid
  /**
   * Loads the pixels of a picture, by default with the browser's own means. Null means that there is no picture, as do HTTP statuses 204,
   * 400, 403, 404 and 410 by default; an error, that it may be tried again.
   */
  loadPixels?: (url: string, signal: AbortSignal) => Promise<Pixels | null>
}

export const TILE_DEFAULTS: Required<TileOptions> = {
  minZoom: 0,
  maxZoom: 15,
  size: 256,
  memory: 64,
  concurrency: 8,
  retries: 3,
  backOff: 0.5,
  attribution: '',
  ellipsoid: Ellipsoid.WGS84,
  loadPixels
}

/** Tiles without anything on them after which the user is told, if there was none with something before. */
const MANY = 4

/** Loads a tile: null if there is none, or nothing on it, an error if it may be tried again. */
export type ReadTile<T> = (url: string, signal: AbortSignal) => Promise<T | null>

/**
 * Reads tiles that are pictures.
 *
 * @param decode - Tile of RGBA pixels; null if nothing is on it.
 */
export function pictureReader<T>(
  { size, loadPixels }: Required<TileOptions>,
  decode: (data: ArrayLike<number>) => T | null
): ReadTile<T> {
  return async (url, signal) => {
    const pixels = await loadPixels(url, signal)
    if (pixels === null || signal.aborted) return null
    const { width, height, data } = pixels
    if (width !== size || height !== size || data.length !== 4 * size ** 2) {
      throw new PermanentFailure(`${url} has ${width} × ${height} pixels, size is ${size}`)
    }
    return decode(data)
  }
}

/** Numbers of tiles. */
export interface TileCounts {
  /** In memory. */
  readonly count: number
  /** Requested, and not yet there. */
  readonly loading: number
  /** Missing on the server, refused, corrupt or of another size: they are not asked for again. */
  readonly absent: number
  /** Memory of the tiles [bytes]. */
  readonly bytes: number
}

/** A tile in memory. */
export interface HeldTile {
  /** True if coarser tiles show through it. */
  readonly hasHoles: boolean
}

/**
 * Tiles of a map, loaded as they are asked for: coarse ones first, and kept within a budget. A tile that does not exist, or is corrupt, is not asked
 * for again; one that fails is tried again. The tiles of the coarsest level stay while all of them take no more than half of the memory.
 */
export class TileStore<T extends HeldTile> {
  readonly #where: string
  readonly #options: Required<TileOptions>
  readonly #url: TileUrl
  readonly #read: ReadTile<T>
  readonly #bytes: number
  readonly #cache: TileCache<T>
  readonly #requests: TileRequests<T>
  /** Tiles that the server does not have. */
  readonly #absent = new Set<number>()
  #version = 0

  /**
   * @param where - Class that the user called.
   * @param wide - Tiles of level 0 from west to east.
   * @param pixelBytes - Memory of a decoded pixel.
   * @param read - Loads a tile.
   * @throws If the address is no template, or an option is out of its range.
   */
  constructor(
    where: string,
    url: string | TileUrl,
    options: Required<TileOptions>,
    readonly wide: number,
    pixelBytes: number,
    read: ReadTile<T>
  ) {
    const { minZoom, maxZoom, size, memory, concurrency, retries } = options
    for (const [name, value, least, most] of [
      ['minZoom', minZoom, 0, 8],
      ['maxZoom', maxZoom, minZoom, 22],
      ['size', size, 2, 4096],
      ['concurrency', concurrency, 1, 100],
      ['retries', retries, 0, 100]
    ] as const) {
      checkRange(where, name, value, least, most)
      if (!Number.isInteger(value)) fail(where, `${name} must be a whole number`, value)
    }
    checkPositive(where, 'memory', memory)
    checkNonNegative(where, 'backOff', options.backOff)
    checkEllipsoid(where, options.ellipsoid)
    this.#where = where
    this.#options = options
    this.#url = typeof url === 'function' ? url : tileUrl(url)
    this.#read = read
    this.#bytes = pixelBytes * size ** 2
    const budget = 1e6 * memory
    const isSmall = wide * 4 ** minZoom * this.#bytes <= budget / 2
    this.#cache = new TileCache(budget, key => isSmall && tileOfKey(key, wide).z === minZoom)
    this.#requests = new TileRequests((key, signal) => this.#load(key, signal), options)
  }

  /** Counts up whenever a tile has arrived. */
  get version(): number {
    return this.#version
  }

  /** Tiles in memory, requests under way, tiles that are not there, and memory of the tiles [bytes]. */
  get tiles(): TileCounts {
    const { size, bytes } = this.#cache
    return { count: size, loading: this.#requests.size, absent: this.#absent.size, bytes }
  }

  /** Level whose pixels at the equator are as fine as a spacing [m]; it counts at all latitudes, so that neighbouring pages agree. */
  levelOf(spacing: number): number {
    const { ellipsoid, size, minZoom, maxZoom } = this.#options
    const pixel = (2 * Math.PI * ellipsoid.maximumRadius) / (this.wide * size)
    return Math.min(Math.max(Math.ceil(Math.log2(pixel / spacing)), minZoom), maxZoom)
  }

  /** A tile in memory, without counting as use. */
  peek(key: number): T | undefined {
    return this.#cache.peek(key)
  }

  /** A tile in memory, used now. */
  get(key: number): T | undefined {
    return this.#cache.get(key)
  }

  /** True if a tile is in memory or will never be. */
  isSettled(key: number): boolean {
    return this.#absent.has(key) || this.#cache.peek(key) !== undefined
  }

  /** Loads a tile, and coarser ones for its holes, and tells each of them. */
  async obtain(
    key: number,
    signal: AbortSignal,
    take: (key: number, tile: T) => void
  ): Promise<void> {
    for (let { z, x, y } = tileOfKey(key, this.wide); z >= this.#options.minZoom; z--) {
      const at = tileKey(z, x, y, this.wide)
      const tile = await this.#tile(at, signal)
      if (tile !== null) take(at, tile)
      if (tile?.hasHoles === false) return
      x >>= 1
      y >>= 1
    }
  }

  /** @returns Null for a tile that does not exist. */
  async #tile(key: number, signal: AbortSignal): Promise<T | null> {
    if (this.#absent.has(key)) return null
    const known = this.#cache.get(key)
    if (known !== undefined) return known
    try {
      // Coarse ones first.
      return await this.#requests.get(key, tileOfKey(key, this.wide).z, signal)
    } catch (error) {
      if (!(error instanceof PermanentFailure)) throw error
      this.#absent.add(key)
      // Once, and not of tiles that are missing among others: all is level ground, which says nothing.
      if (this.#version === 0 && this.#absent.size === MANY) {
        // oxlint-disable-next-line no-console -- A tile must not throw, and there is nobody else to tell.
        console.warn(`${this.#where}: no tile so far, ${error.message}`)
      }
      return null
    }
  }

  async #load(key: number, signal: AbortSignal): Promise<T> {
    const { z, x, y } = tileOfKey(key, this.wide)
    const url = this.#url(z, x, y)
    const tile = await this.#read(url, signal)
    if (signal.aborted) throw new PermanentFailure('given up')
    if (tile === null) throw new PermanentFailure(`${url} is missing, refused or corrupt`)
    this.#cache.set(key, tile, this.#bytes)
    this.#version++
    return tile
  }

  /** Gives up all requests and lets the tiles go. */
  clear(): void {
    this.#requests.clear()
    this.#cache.clear()
    this.#absent.clear()
    this.#version++
  }
}

/** Keys of the tiles whose pixels some places need. */
export class TilesAbout {
  readonly keys = new Set<number>()
  #last = NaN

  /**
   * @param margin - Pixels about a place that count, per size of a tile.
   * @param wide - Tiles of level 0 from west to east.
   */
  constructor(
    readonly margin: number,
    readonly wide = 1
  ) {}

  /**
   * Adds the tiles about a place.
   *
   * @param x - Column in [0, 1), `y` row in [0, 1], of the whole map.
   */
  add(z: number, x: number, y: number): void {
    const { keys, margin, wide } = this
    const [column, row] = [x * wide * 2 ** z, y * 2 ** z]
    const left = Math.floor(column - margin)
    const right = Math.floor(column + margin)
    const top = Math.floor(row - margin)
    const bottom = Math.floor(row + margin)
    if (left === right && top === bottom) {
      const key = tileKey(z, left, top, wide)
      // Neighbouring places mostly need the same.
      if (key !== this.#last) keys.add((this.#last = key))
      return
    }
    for (let i = left; i <= right; i++) {
      for (let j = top; j <= bottom; j++) keys.add(tileKey(z, i, j, wide))
    }
  }
}
