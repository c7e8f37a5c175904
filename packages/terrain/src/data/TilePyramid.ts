import { tileKey } from './mercator'
import type { PagePlaces } from './pagePlaces'
import { sampleRaster, valueInside, type RasterSample } from './RasterSampler'

/** Heights of a tile, row by row from its north-west corner [m]; NaN where there is none. */
export interface HeightTile {
  readonly heights: Float32Array
  readonly hasHoles: boolean
}

const scratch: RasterSample = { value: 0, x: 0, y: 0 }

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
    if (find !== this.#find) this.#lastZ = -1
    this.#find = find
    const scale = this.size * 2 ** z
    const column = x * this.wide * scale - 0.5
    const row = y * scale - 0.5
    sampleRaster((i, j) => this.#pixelAt(z, i, j), column, row, target)
    target.x *= this.wide * scale
    target.y *= scale
    return target
  }

  /** Heights alone at places, as of `sample`. */
  fill(z: number, { x, y }: PagePlaces, find: FindTile, heights: Float32Array): void {
    const { size } = this
    const scale = size * 2 ** z
    const wide = this.wide * scale
    /** Place and heights of the tile at hand; null if it has holes, or is not there. */
    let [left, top] = [NaN, NaN]
    let inside: Float32Array | null = null
    for (let i = 0; i < heights.length; i++) {
      const column = x[i] * wide - 0.5
      const row = y[i] * scale - 0.5
      if (!(column >= left && row >= top && column < left + size && row < top + size)) {
        left = Math.floor(column / size) * size
        top = Math.floor(row / size) * size
        const tile = find(tileKey(z, left / size, top / size, this.wide))
        inside = tile?.hasHoles === false ? tile.heights : null
      }
      const [across, down] = [column - left, row - top]
      const isInside = across >= 1 && down >= 1 && across < size - 2 && down < size - 2
      heights[i] =
        isInside && inside !== null
          ? valueInside(inside, size, across, down)
          : this.sample(z, x[i], y[i], find, scratch).value
    }
  }

  /** Forgets the tile that was found last. */
  forget(): void {
    this.#find = () => undefined
    this.#last = undefined
    this.#lastZ = -1
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

  #pixelAt(z: number, column: number, row: number): number {
    const { size } = this
    const inMap = Math.min(Math.max(row, 0), size * 2 ** z - 1)
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
