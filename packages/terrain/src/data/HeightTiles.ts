import { MathUtils, type Vector3 } from 'three'
import { checkRange, withDefaults } from '@welkin/atmosphere'
import { checkEllipsoid, checkNonNegative, checkPositive, Ellipsoid, fail } from '@welkin/geo'
import type { HeightSample } from '../heights/HeightSource'
import type { PageRequest, PageSource } from '../pages/PageSource'
import { geographicGradient, geographicPlace, type GeographicPlace } from './geographic'
import { loadPixels, type Pixels } from './loadPixels'
import {
  isPolar,
  MERCATOR_LIMIT,
  mercatorLatitude,
  mercatorX,
  mercatorY,
  POLAR,
  tileKey,
  tileOfKey
} from './mercator'
import { pagePlaces, type PagePlaces } from './pagePlaces'
import { OVERSHOOT, type RasterSample } from './RasterSampler'
import { TileCache } from './TileCache'
import { TilePyramid, type FindTile, type HeightTile } from './TilePyramid'
import { PermanentFailure, TileRequests } from './TileRequests'
import { tileUrl, type TileUrl } from './tileUrl'

/** Options of {@link TerrariumTiles} and {@link TerrainRGBTiles}. */
export interface HeightTilesOptions {
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
  /** Bounds of what is taken for a height, default −11,500 (Terrain-RGB −9,999) and 9,000: other pixels are holes [m]. */
  lowest?: number
  highest?: number
  /** Steepest slope that the data has, > 0, default 3: rise over way [–]. */
  steepest?: number
  /** Line that names the data's source, default ''. */
  attribution?: string
  /** Default WGS84; one of revolution. */
  ellipsoid?: Ellipsoid
  /**
   * Loads the pixels of a picture, by default with the browser's own means. Null says that there is none, as do answers 204,
   * 400, 403, 404 and 410 by default; an error, that it may be tried again.
   */
  loadPixels?: (url: string, signal: AbortSignal) => Promise<Pixels | null>
}

const DEFAULTS: Required<HeightTilesOptions> = {
  minZoom: 0,
  maxZoom: 15,
  size: 256,
  memory: 64,
  concurrency: 8,
  retries: 3,
  backOff: 0.5,
  lowest: -11_500,
  highest: 9000,
  steepest: 3,
  attribution: '',
  ellipsoid: Ellipsoid.WGS84,
  loadPixels
}

/** Columns of the map's edge whose mean is the height of a pole. */
const EDGE_COLUMNS = Array.from({ length: 16 }, (_, i) => (i + 0.5) / 16)

const place: GeographicPlace = { longitude: 0, latitude: 0 }
const near: RasterSample = { value: 0, x: 0, y: 0 }
const polar: RasterSample = { value: 0, x: 0, y: 0 }

/** Height of a pixel's colour, each of 0 to 255 [m]. */
export type DecodeHeight = (red: number, green: number, blue: number) => number

/**
 * Heights that are loaded as pictures in tiles of Web Mercator, as they are needed.
 *
 * What is there is used: a tile that does not exist, or is corrupt, is a hole that shows the coarser one; one that fails is tried
 * again, and its page is left to its parent meanwhile. The tiles of the coarsest level stay while all of them take no more than
 * half of the memory.
 */
export class HeightTiles implements PageSource {
  readonly lowest: number
  readonly highest: number
  /** Line that names the data's source. */
  readonly attribution: string
  /** Finest level that the server has. */
  readonly maxZoom: number
  /** Coarsest level that the server has. */
  readonly minZoom: number
  readonly #options: Required<HeightTilesOptions>
  readonly #url: TileUrl
  readonly #decode: DecodeHeight
  readonly #pyramid: TilePyramid
  readonly #cache: TileCache<HeightTile>
  readonly #requests: TileRequests<HeightTile>
  /** Tiles that the server does not have. */
  readonly #absent = new Set<number>()
  #version = 0

  /**
   * @param where - Class that the user called.
   * @throws If the address is no template, or an option is unknown or out of its range.
   */
  constructor(
    where: string,
    url: string | TileUrl,
    decode: DecodeHeight,
    options: HeightTilesOptions = {}
  ) {
    const all = withDefaults(where, DEFAULTS, options)
    const { minZoom, maxZoom, size, memory, concurrency, retries, lowest, highest } = all
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
    checkNonNegative(where, 'backOff', all.backOff)
    checkPositive(where, 'steepest', all.steepest)
    checkRange(where, 'highest', highest, lowest, 1e5)
    checkRange(where, 'lowest', lowest, -1e5, highest)
    checkEllipsoid(where, all.ellipsoid)
    this.#options = all
    this.#url = typeof url === 'function' ? url : tileUrl(url)
    this.#decode = decode
    this.minZoom = minZoom
    this.maxZoom = maxZoom
    this.attribution = all.attribution
    // Between pixels heights may go beyond theirs.
    this.lowest = lowest - OVERSHOOT * 1000
    this.highest = highest + OVERSHOOT * 1000
    this.#pyramid = new TilePyramid(size, minZoom, Math.min(Math.max(0, lowest), highest))
    const budget = 1e6 * memory
    const isSmall = 4 ** minZoom * Float32Array.BYTES_PER_ELEMENT * size ** 2 <= budget / 2
    this.#cache = new TileCache(budget, key => isSmall && tileOfKey(key).z === minZoom)
    this.#requests = new TileRequests((key, signal) => this.#loadTile(key, signal), all)
  }

  /** Counts up whenever heights have arrived. */
  get version(): number {
    return this.#version
  }

  /** Tiles in memory, requests under way, and memory of the tiles [bytes]. */
  get tiles(): { count: number; loading: number; bytes: number } {
    const { size, bytes } = this.#cache
    return { count: size, loading: this.#requests.size, bytes }
  }

  variation(distance: number): number {
    return Math.min(this.#options.steepest * distance, this.highest - this.lowest)
  }

  /** Height and gradient from the finest tile that is there. */
  sampleAt(positionECEF: Vector3, target: HeightSample): HeightSample {
    const { radii } = this.#options.ellipsoid
    geographicPlace(positionECEF, radii, place)
    const x = mercatorX(place.longitude)
    const y = mercatorY(place.latitude)
    let z = this.maxZoom
    const keyAt = (): number => tileKey(z, Math.floor(x * 2 ** z), Math.floor(y * 2 ** z))
    while (z > this.minZoom && this.#cache.peek(keyAt()) === undefined) z--
    this.#cache.get(keyAt())
    // A new function each time: the tiles that were found before may be others now.
    this.#sample(z, x, y, key => this.#cache.peek(key), near)
    target.height = near.value
    // Rows are stretched by 1 / cos latitude.
    const byLongitude = near.x / (2 * Math.PI)
    const byLatitude = -near.y / (2 * Math.PI * Math.max(Math.cos(place.latitude), 1e-3))
    geographicGradient(place, byLongitude, byLatitude, positionECEF, radii, target.gradient)
    return target
  }

  loadHeights(request: PageRequest, signal: AbortSignal): Float32Array | Promise<Float32Array> {
    const { maximumRadius } = this.#options.ellipsoid
    const { side, spacing } = request
    const { size } = this.#pyramid
    // Of the equator everywhere: neighbouring pages shall agree.
    const finest = Math.ceil(Math.log2((2 * Math.PI * maximumRadius) / size / spacing))
    const z = Math.min(Math.max(finest, this.minZoom), this.maxZoom)
    const held = new Map<number, HeightTile>()
    const find: FindTile = key => held.get(key) ?? this.#cache.peek(key)
    const places = pagePlaces(request, (at, target) => this.#project(at, target), 1)
    const keys = this.#keysOf(z, places)
    const fill = (): Float32Array => {
      const heights = new Float32Array(side * side)
      for (let i = 0; i < heights.length; i++) {
        const [x, y] = [places.x[i], places.y[i]]
        heights[i] = isPolar(y)
          ? this.#sample(z, x, y, find, near).value
          : this.#pyramid.valueAt(z, x, y, find)
      }
      return heights
    }
    const missing = [...keys].filter(key => {
      const tile = this.#cache.get(key)
      if (tile !== undefined) held.set(key, tile)
      return tile?.hasHoles !== false
    })
    if (missing.length === 0) return fill()
    return Promise.all(missing.map(key => this.#obtain(key, signal, held))).then(fill)
  }

  /** Gives up all requests and lets the tiles go. */
  dispose(): void {
    this.#requests.clear()
    this.#cache.clear()
    this.#absent.clear()
    this.#pyramid.forget()
    this.#version++
  }

  /** Place on the map. */
  #project(positionECEF: Vector3, target: { x: number; y: number }): void {
    geographicPlace(positionECEF, this.#options.ellipsoid.radii, place)
    target.x = mercatorX(place.longitude)
    target.y = mercatorY(place.latitude)
  }

  /** Tiles of which places need pixels. */
  #keysOf(z: number, { x, y }: PagePlaces): Set<number> {
    const { size, coarsest } = this.#pyramid
    const keys = new Set<number>()
    const margin = 2 / size
    let last = NaN
    const add = (level: number, column: number, row: number): void => {
      const scale = 2 ** level
      const left = Math.floor(column * scale - margin)
      const right = Math.floor(column * scale + margin)
      const top = Math.floor(row * scale - margin)
      const bottom = Math.floor(row * scale + margin)
      if (left === right && top === bottom) {
        const key = tileKey(level, left, top)
        if (key !== last) keys.add((last = key))
        return
      }
      for (const i of [left, right]) {
        for (const j of [top, bottom]) keys.add(tileKey(level, i, j))
      }
    }
    const edges = new Set<number>()
    for (let i = 0; i < x.length; i++) {
      if (y[i] >= 0 && y[i] <= 1) add(z, x[i], y[i])
      else edges.add(y[i] < 0 ? 0 : 1)
      if (isPolar(y[i])) add(coarsest, x[i], y[i])
    }
    for (const y of edges) for (const column of EDGE_COLUMNS) add(coarsest, column, y)
    return keys
  }

  /** Loads a tile, and coarser ones for its holes. */
  async #obtain(key: number, signal: AbortSignal, held: Map<number, HeightTile>): Promise<void> {
    for (let { z, x, y } = tileOfKey(key); z >= this.minZoom; z--, x >>= 1, y >>= 1) {
      const at = tileKey(z, x, y)
      const tile = await this.#tile(at, signal)
      if (tile !== null) held.set(at, tile)
      if (tile?.hasHoles === false) return
    }
  }

  /** @returns Null for a tile that does not exist. */
  async #tile(key: number, signal: AbortSignal): Promise<HeightTile | null> {
    if (this.#absent.has(key)) return null
    const known = this.#cache.get(key)
    if (known !== undefined) return known
    try {
      // Coarse ones first.
      return await this.#requests.get(key, tileOfKey(key).z, signal)
    } catch (error) {
      if (!(error instanceof PermanentFailure)) throw error
      this.#absent.add(key)
      return null
    }
  }

  async #loadTile(key: number, signal: AbortSignal): Promise<HeightTile> {
    const { z, x, y } = tileOfKey(key)
    const pixels = await this.#options.loadPixels(this.#url(z, x, y), signal)
    if (signal.aborted) throw new PermanentFailure('given up')
    const { size } = this.#pyramid
    const count = size * size
    if (pixels?.width !== size || pixels.height !== size || pixels.data.length !== 4 * count) {
      throw new PermanentFailure(`no picture of ${size} × ${size} pixels`)
    }
    const { lowest, highest } = this.#options
    const { data } = pixels
    const heights = new Float32Array(count)
    let holes = 0
    for (let i = 0; i < count; i++) {
      const height = this.#decode(data[4 * i], data[4 * i + 1], data[4 * i + 2])
      const isHeight = data[4 * i + 3] > 0 && height >= lowest && height <= highest
      heights[i] = isHeight ? height : NaN
      if (!isHeight) holes++
    }
    if (holes === count) throw new PermanentFailure('no heights')
    const tile = { heights, hasHoles: holes > 0 }
    this.#cache.set(key, tile, heights.byteLength)
    this.#version++
    return tile
  }

  /** Height at a place, and its slopes per width of the map. */
  #sample(z: number, x: number, y: number, find: FindTile, target: RasterSample): RasterSample {
    if (y >= 0 && y <= 1) this.#pyramid.sample(z, x, y, find, target)
    if (!isPolar(y)) return target
    const latitude = Math.abs(mercatorLatitude(y))
    const edge = Math.min(Math.max(y, 0), 1)
    // Towards the pole: the coarsest level, then its mean along the edge of the map.
    const cap = MathUtils.smoothstep(latitude, MERCATOR_LIMIT, Math.PI / 2)
    const mean = cap > 0 ? this.#edgeMean(edge, find) : 0
    this.#pyramid.sample(this.minZoom, x, edge, find, polar)
    const value = polar.value + cap * (mean - polar.value)
    const share = MathUtils.smoothstep(latitude, POLAR, MERCATOR_LIMIT)
    if (share === 1) target.value = value
    else target.value += share * (value - target.value)
    // The slope of the changeover itself is below 1 %.
    target.x *= 1 - share
    target.y *= 1 - share
    return target
  }

  /** Mean of the heights along an edge of the map. */
  #edgeMean(y: number, find: FindTile): number {
    let sum = 0
    for (const x of EDGE_COLUMNS) {
      sum += this.#pyramid.sample(this.minZoom, x, y, find, polar).value
    }
    return sum / EDGE_COLUMNS.length
  }
}
