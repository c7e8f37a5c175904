import { tileKey } from './mercator'
import type { PagePlaces } from './pagePlaces'
import { fillInside, sampleRaster, valueInside, type RasterSample } from './RasterSampler'

/** Heights of a tile, row by row from its north-west corner [m]; NaN where there is none. */
export interface HeightTile {
  readonly heights: Float32Array
  readonly hasHoles: boolean
}

/** Heights of places between pixels: of one by its number, and of all. */
export interface HeightsBetween {
  readonly at: (place: number) => number
  readonly into: (target: Float32Array) => Float32Array
}

/** Pixels that are copied for a page, per place of it. */
const MOST_PIXELS = 4

/** Finds a tile by its key; undefined if it is not there. */
export type FindTile = (key: number) => HeightTile | undefined

/**
 * Heights between the pixels of a level of tiles. Where a tile or a pixel is missing, those of coarser levels stand in.
 */
export class TilePyramid {
  #find: FindTile = () => undefined
  /** Tile that was found last. */
  #lastZ = -1
  #lastX = 0
  #lastY = 0
  #last: HeightTile | undefined

  /**
   * @param size - Pixels along a tile's edge.
   * @param coarsest - Level that ends the search.
   * @param otherwise - Height where no level has one [m].
   * @param wide - Tiles of level 0 from west to east.
   */
  constructor(
    readonly size: number,
    readonly coarsest: number,
    readonly otherwise: number,
    readonly wide = 1
  ) {}

  /**
   * Height at a place.
   *
   * @param x - Column in [0, 1), `y` row in [0, 1], of the whole map.
   * @returns Value [m] and slopes per width of the map.
   */
  sample(z: number, x: number, y: number, find: FindTile, target: RasterSample): RasterSample {
    this.#begin(find)
    const scale = this.size * 2 ** z
    const column = x * this.wide * scale - 0.5
    const row = y * scale - 0.5
    sampleRaster((i, j) => this.#pixelAt(z, i, j), column, row, target)
    target.x *= this.wide * scale
    target.y *= scale
    return target
  }

  /** Height at a place, linear between pixels, where no slope is asked for; arguments as of {@link sample}. */
  heightAt(z: number, x: number, y: number, find: FindTile): number {
    this.#begin(find)
    const scale = this.size * 2 ** z
    const column = x * this.wide * scale - 0.5
    const row = y * scale - 0.5
    const [i, j] = [Math.floor(column), Math.floor(row)]
    const right = column - i
    const upper = this.#pixelAt(z, i, j) * (1 - right) + this.#pixelAt(z, i + 1, j) * right
    const lower = this.#pixelAt(z, i, j + 1) * (1 - right) + this.#pixelAt(z, i + 1, j + 1) * right
    return upper + (row - j) * (lower - upper)
  }

  /**
   * Pixels about all places of a page, and a function of the height between them: those of a tile if it has all of them, else a copy. Null if there were
   * more than {@link MOST_PIXELS} times as many as places, as across the antimeridian.
   */
  heightsBetween(z: number, places: PagePlaces, find: FindTile): HeightsBetween | null {
    this.#begin(find)
    const { size } = this
    const scale = size * 2 ** z
    const wide = this.wide * scale
    const { x, y } = places
    const { west, east, north, south } = places.extent
    let left = Math.floor(west * wide - 0.5) - 1
    let top = Math.floor(north * scale - 0.5) - 1
    let width = Math.floor(east * wide - 0.5) + 3 - left
    const height = Math.floor(south * scale - 0.5) + 3 - top
    if (width * height > MOST_PIXELS * x.length) return null
    const tile = this.#tileAt(z, left, top)
    const isInside = (from: number, count: number): boolean =>
      Math.floor(from / size) === Math.floor((from + count - 1) / size)
    let values: Float32Array
    if (tile?.hasHoles === false && isInside(left, width) && isInside(top, height)) {
      values = tile.heights
      left = Math.floor(left / size) * size
      top = Math.floor(top / size) * size
      width = size
    } else {
      values = new Float32Array(width * height)
      for (let n = 0; n < values.length; n += width) {
        this.#copyRow(z, left, top + n / width, values.subarray(n, n + width))
      }
    }
    return {
      at: i => valueInside(values, width, x[i] * wide - 0.5 - left, y[i] * scale - 0.5 - top),
      into: target =>
        fillInside(values, width, places, { scale: [wide, scale], first: [left, top] }, target)
    }
  }

  /** Forgets the tile that was found last. */
  forget(): void {
    this.#find = () => undefined
    this.#last = undefined
    this.#lastZ = -1
  }

  #begin(find: FindTile): void {
    if (find !== this.#find) this.#lastZ = -1
    this.#find = find
  }

  #tileAt(z: number, column: number, row: number): HeightTile | undefined {
    const x = Math.floor(column / this.size)
    const y = Math.floor(row / this.size)
    if (z !== this.#lastZ || x !== this.#lastX || y !== this.#lastY) {
      this.#lastZ = z
      this.#lastX = x
      this.#lastY = y
      this.#last = this.#find(tileKey(z, x, y, this.wide))
    }
    return this.#last
  }

  /** Nearest row of the map. */
  #inMap(z: number, row: number): number {
    return Math.min(Math.max(row, 0), this.size * 2 ** z - 1)
  }

  /** Copies pixels of a row, those of a tile without holes at once. */
  #copyRow(z: number, left: number, row: number, target: Float32Array): void {
    const { size } = this
    const inMap = this.#inMap(z, row)
    for (let n = 0; n < target.length;) {
      const column = left + n
      const x = column - Math.floor(column / size) * size
      const count = Math.min(size - x, target.length - n)
      const tile = this.#tileAt(z, column, inMap)
      if (tile?.hasHoles === false) {
        const start = (inMap % size) * size + x
        target.set(tile.heights.subarray(start, start + count), n)
      } else {
        for (let i = 0; i < count; i++) target[n + i] = this.#pixelAt(z, column + i, row)
      }
      n += count
    }
  }

  #pixelAt(z: number, column: number, row: number): number {
    const { size } = this
    const inMap = this.#inMap(z, row)
    const tile = this.#tileAt(z, column, inMap)
    if (tile !== undefined) {
      const x = column - Math.floor(column / size) * size
      const height = tile.heights[(inMap % size) * size + x]
      if (!Number.isNaN(height)) return height
    }
    return this.#coarserAt(z, column + 0.5, inMap + 0.5)
  }

  /** Height at a place of a level, from the finest coarser level that has one: linear within its tile. */
  #coarserAt(z: number, column: number, row: number): number {
    const { size } = this
    for (let level = z - 1; level >= this.coarsest; level--) {
      const x = column / 2 ** (z - level)
      const y = row / 2 ** (z - level)
      const tile = this.#find(tileKey(level, Math.floor(x / size), Math.floor(y / size), this.wide))
      if (tile === undefined) continue
      const height = linear(tile.heights, size, x % size, y % size)
      if (!Number.isNaN(height)) return height
    }
    return this.otherwise
  }
}

/** Value between the centres of a tile's pixels; NaN beside one that is. */
function linear(heights: Float32Array, size: number, x: number, y: number): number {
  const left = Math.min(Math.max(x < 0 ? x + size : x, 0.5), size - 0.5) - 0.5
  const top = Math.min(Math.max(y, 0.5), size - 0.5) - 0.5
  const column = Math.min(Math.floor(left), size - 2)
  const row = Math.min(Math.floor(top), size - 2)
  const at = (i: number, j: number): number => heights[(row + j) * size + column + i]
  const right = left - column
  const down = top - row
  const upper = at(0, 0) * (1 - right) + at(1, 0) * right
  const lower = at(0, 1) * (1 - right) + at(1, 1) * right
  return upper * (1 - down) + lower * down
}
