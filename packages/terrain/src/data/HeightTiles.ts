import { MathUtils, type Vector3 } from 'three'
import { checkRange, withDefaults } from '@welkin/atmosphere'
import { checkPositive } from '@welkin/geo'
import type { HeightSample } from '../heights/HeightSource'
import { levelOf } from '../heights/sampleGround'
import type { PageRequest, PageSource } from '../pages/PageSource'
import { appendSky } from './appendSky'
import {
  geographicGradient,
  geographicPlace,
  geographicY,
  type GeographicPlace
} from './geographic'
import {
  isPolar,
  MERCATOR_LIMIT,
  mercatorLatitude,
  mercatorX,
  mercatorY,
  POLAR,
  tileKey
} from './mercator'
import { fillSmooth, pagePlaces, type PagePlaces } from './pagePlaces'
import { OVERSHOOT, type RasterSample } from './RasterSampler'
import { TilePyramid, type FindTile, type HeightTile } from './TilePyramid'
import {
  pictureReader,
  TILE_DEFAULTS,
  TilesAbout,
  TileStore,
  type ReadTile,
  type TileCounts,
  type TileOptions
} from './TileStore'
import type { TileUrl } from './tileUrl'

/** Options of {@link TerrariumTiles} and {@link TerrainRGBTiles}. */
export interface HeightTilesOptions extends TileOptions {
  /** Least number that is taken for a height, default −11,500 (Terrain-RGB −9,999): lower pixels are holes [m]. */
  lowest?: number
  /** Greatest number that is taken for a height, default 9,000: higher pixels are holes [m]. */
  highest?: number
  /** Steepest slope that the data has, > 0, default 3: rise over run [–]. */
  steepest?: number
}

const DEFAULTS: Required<HeightTilesOptions> = {
  ...TILE_DEFAULTS,
  lowest: -11_500,
  highest: 9000,
  steepest: 3
}

/** Columns of the map's edge whose mean is the height of a pole. */
const EDGE_COLUMNS = Array.from({ length: 16 }, (_, i) => (i + 0.5) / 16)

/** Steps between the places of a page whose tiles are looked up. */
const STRIDE = 8

const place: GeographicPlace = { longitude: 0, latitude: 0 }
const near: RasterSample = { value: 0, x: 0, y: 0 }
const polar: RasterSample = { value: 0, x: 0, y: 0 }

/** Makes a loader of tiles from all options. */
export type ReaderOfHeights = (options: Required<HeightTilesOptions>) => ReadTile<HeightTile>

/** Height of a pixel's colour, each of 0 to 255 [m]. */
export type DecodeHeight = (red: number, green: number, blue: number) => number

/** Reads heights from pictures. */
export const readerOfPictures =
  (decode: DecodeHeight): ReaderOfHeights =>
  options =>
    pictureReader(options, data => {
      const heights = new Float32Array(options.size ** 2)
      for (let i = 0; i < heights.length; i++) {
        const at = 4 * i
        heights[i] = data[at + 3] > 0 ? decode(data[at], data[at + 1], data[at + 2]) : NaN
      }
      return heightTile(heights, options)
    })

/** Tile of heights: those beyond `lowest` and `highest`, or NaN, are holes. Null if all are. */
export function heightTile(
  heights: Float32Array,
  { lowest, highest }: Required<HeightTilesOptions>
): HeightTile | null {
  let holes = 0
  for (let i = 0; i < heights.length; i++) {
    if (heights[i] >= lowest && heights[i] <= highest) continue
    heights[i] = NaN
    holes++
  }
  return holes < heights.length ? { heights, hasHoles: holes > 0 } : null
}

/**
 * Heights in tiles of Web Mercator or of longitude and latitude, loaded as they are needed.
 *
 * A tile that does not exist, or is corrupt, is a hole that shows the coarser one; one that fails is tried again, and meanwhile its page is
 * drawn with its parent's. The tiles of the coarsest level stay while all of them take no more than
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
  readonly #pyramid: TilePyramid
  readonly #store: TileStore<HeightTile>
  /** False of a map of longitude and latitude, which has rows up to the poles. */
  readonly #isMercator: boolean

  /**
   * @param where - Class that the user called.
   * @param readerOf - Loads tiles, by all options.
   * @param isMercator - True of tiles of Web Mercator, false of longitude and latitude, two at level 0.
   * @throws If the address is no template, or an option is unknown or out of its range.
   */
  constructor(
    where: string,
    url: string | TileUrl,
    readerOf: ReaderOfHeights,
    options: HeightTilesOptions = {},
    isMercator = true
  ) {
    const all = withDefaults(where, DEFAULTS, options)
    const { minZoom, maxZoom, size, lowest, highest } = all
    const bytes = Float32Array.BYTES_PER_ELEMENT
    const wide = isMercator ? 1 : 2
    this.#store = new TileStore(where, url, all, wide, bytes, readerOf(all))
    checkPositive(where, 'steepest', all.steepest)
    checkRange(where, 'highest', highest, lowest, 1e5)
    checkRange(where, 'lowest', lowest, -1e5, highest)
    this.#options = all
    this.minZoom = minZoom
    this.maxZoom = maxZoom
    this.attribution = all.attribution
    // Bicubic interpolation overshoots the pixels' heights.
    this.lowest = lowest - OVERSHOOT * 1000
    this.highest = highest + OVERSHOOT * 1000
    this.#pyramid = new TilePyramid(size, minZoom, levelOf(all), wide)
    this.#isMercator = isMercator
  }

  /** Counts up whenever heights have arrived. */
  get version(): number {
    return this.#store.version
  }

  /** Tiles in memory, requests under way, tiles that are not there, and memory of the tiles [bytes]. */
  get tiles(): TileCounts {
    return this.#store.tiles
  }

  variation(distance: number): number {
    return Math.min(this.#options.steepest * distance, this.highest - this.lowest)
  }

  /** Height and gradient from the finest tile in memory. */
  sampleAt(positionECEF: Vector3, target: HeightSample): HeightSample {
    const { radii } = this.#options.ellipsoid
    geographicPlace(positionECEF, radii, place)
    const x = mercatorX(place.longitude)
    const y = this.#rowOf(place.latitude)
    let z = this.maxZoom
    while (z > this.minZoom && this.#store.peek(this.#keyAt(z, x, y)) === undefined) z--
    this.#store.get(this.#keyAt(z, x, y))
    // A new function each time: the tiles that were found before may be others now.
    this.#sample(z, x, y, key => this.#store.peek(key), near)
    target.height = near.value
    const byLongitude = near.x / (2 * Math.PI)
    // Rows of Web Mercator are stretched by 1 / cos latitude.
    const stretch = this.#isMercator ? 2 * Math.max(Math.cos(place.latitude), 1e-3) : 1
    const byLatitude = -near.y / (Math.PI * stretch)
    geographicGradient(place, byLongitude, byLatitude, positionECEF, radii, target.gradient)
    return target
  }

  loadHeights(request: PageRequest, signal: AbortSignal): Float32Array | Promise<Float32Array> {
    const { side, spacing } = request
    const z = this.#store.levelOf(spacing)
    const held = new Map<number, HeightTile>()
    const find: FindTile = key => held.get(key) ?? this.#store.peek(key)
    const placesOf = (): PagePlaces =>
      pagePlaces(request, (at, target) => this.#project(at, target), 1)
    const first = placesOf()
    const keys = this.#keysOf(z, first, side)
    const fillHeights = (places: PagePlaces, heights: Float32Array): Float32Array => {
      const between = this.#pyramid.heightsBetween(z, places, find)
      const isWhole = [...keys].every(key => find(key)?.hasHoles === false)
      const scale = this.#pyramid.size * 2 ** z
      const pixels = [this.#store.wide * scale, scale] as const
      const { north, south } = places.extent
      if (between !== null && !this.#isPolar(north) && !this.#isPolar(south)) {
        const isSmooth = isWhole && fillSmooth(places, side, pixels, between.at, heights)
        return isSmooth ? heights : between.into(heights)
      }
      const { x, y } = places
      for (let i = 0; i < heights.length; i++) {
        heights[i] =
          between === null || this.#isPolar(y[i])
            ? this.#sample(z, x[i], y[i], find, near).value
            : between.at(i)
      }
      return heights
    }
    const fill = (places: PagePlaces): Float32Array => {
      const heights = fillHeights(places, new Float32Array(side * side))
      return appendSky(heights, request, i => {
        const [left, top] = [places.x[i], places.y[i]]
        const perMeter = 1 / (2 * Math.PI * this.#options.ellipsoid.radii.x)
        const latitude = this.#isMercator ? mercatorLatitude(top) : Math.PI * (0.5 - top)
        const across = perMeter / Math.max(Math.cos(latitude), 1e-3)
        const down = this.#isMercator ? across : 2 * perMeter
        return (east, north, detail) => {
          const [x, y] = [left + east * across, MathUtils.clamp(top - north * down, 0, 1)]
          let level = Math.min(z, this.#store.levelOf(detail / 2))
          // Coarser tiles have mostly come before; where they have gone a finer one stands in.
          while (level < z && find(this.#keyAt(level, x, y)) === undefined) level++
          return this.#pyramid.heightAt(level, x, y, find)
        }
      })
    }
    const missing = [...keys].filter(key => {
      const tile = this.#store.get(key)
      if (tile !== undefined) held.set(key, tile)
      return tile?.hasHoles !== false
    })
    if (missing.length === 0) return fill(first)
    const take = (key: number, tile: HeightTile): void => void held.set(key, tile)
    // By then other pages have filled the arrays of places.
    return Promise.all(missing.map(key => this.#store.obtain(key, signal, take))).then(() =>
      fill(placesOf())
    )
  }

  /** Gives up all requests and lets the tiles go. */
  dispose(): void {
    this.#store.clear()
    this.#pyramid.forget()
  }

  /** Key of the tile of a level at a place of the map. */
  #keyAt(z: number, x: number, y: number): number {
    const { wide } = this.#store
    return tileKey(z, Math.floor(x * wide * 2 ** z), Math.floor(y * 2 ** z), wide)
  }

  #rowOf(latitude: number): number {
    return this.#isMercator ? mercatorY(latitude) : geographicY(latitude)
  }

  /** True for a row near a pole, beyond the map or close to its end. */
  #isPolar(y: number): boolean {
    return this.#isMercator && isPolar(y)
  }

  /** Place on the map. */
  #project(positionECEF: Vector3, target: { x: number; y: number }): void {
    geographicPlace(positionECEF, this.#options.ellipsoid.radii, place)
    target.x = mercatorX(place.longitude)
    target.y = this.#rowOf(place.latitude)
  }

  /** Keys of the tiles whose pixels some places need: of every so many in a row and column, and about them. */
  #keysOf(z: number, { x, y, isSmooth }: PagePlaces, side: number): Set<number> {
    const { size, coarsest } = this.#pyramid
    const { wide } = this.#store
    const stride = isSmooth ? STRIDE : 1
    // Half of the way to the next in the diagonal, at most.
    const middle = (side * side) >> 1
    const reach = (values: Float64Array, unit: number): number =>
      unit *
      (Math.abs(values[middle + 1] - values[middle]) +
        Math.abs(values[middle + side] - values[middle]))
    const around = isSmooth ? STRIDE * Math.max(reach(x, wide), reach(y, 1)) * 2 ** z : 0
    const about = new TilesAbout(2 / size + around, wide)
    const edges = new Set<number>()
    for (let row = 0; row < side; row += stride) {
      for (let column = 0; column < side; column += stride) {
        const i = row * side + column
        if (y[i] >= 0 && y[i] <= 1) about.add(z, x[i], y[i])
        else edges.add(y[i] < 0 ? 0 : 1)
        if (this.#isPolar(y[i])) about.add(coarsest, x[i], y[i])
      }
    }
    for (const y of edges) for (const column of EDGE_COLUMNS) about.add(coarsest, column, y)
    return about.keys
  }

  /** Height at a place, and its slopes per width of the map. */
  #sample(z: number, x: number, y: number, find: FindTile, target: RasterSample): RasterSample {
    if (y >= 0 && y <= 1) this.#pyramid.sample(z, x, y, find, target)
    if (!this.#isPolar(y)) return target
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
