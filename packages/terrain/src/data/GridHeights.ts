import { MathUtils, type Vector3 } from 'three'
import {
  checkEllipsoid,
  checkFinite,
  checkNonNegative,
  checkOptions,
  Ellipsoid,
  fail
} from '@welkin/geo'
import type { HeightSample } from '../heights/HeightSource'
import type { PageRequest, PageSource } from '../pages/PageSource'
import { appendSky } from './appendSky'
import { geographicGradient, geographicPlace, type GeographicPlace } from './geographic'
import { fillSmooth, pagePlaces, type Extent, type PagePlaces } from './pagePlaces'
import { boundsOf, fillHoles, halved, type Raster } from './Raster'
import {
  fillInside,
  OVERSHOOT,
  sampleRaster,
  STEEPENING,
  valueInside,
  type RasterSample
} from './RasterSampler'

/** A grid of heights, and options of {@link GridHeights}. */
export interface GridHeightsOptions {
  /** Columns from west to east, ≥ 2. */
  width: number
  /** Rows from north to south, ≥ 2. */
  height: number
  /** Outer edge of the first column [°], or as `units` says. */
  west: number
  /** Outer edge of the last column [°], or as `units` says: more than `west`, by at most 360°. */
  east: number
  /** Outer edge of the last row [°], or as `units` says. */
  south: number
  /** Outer edge of the first row [°], or as `units` says. */
  north: number
  /** Units of the edges: `'degrees'`, the default, or for a flat world `'meters'`, to the east along +X and to the north along −Z. */
  units?: 'degrees' | 'meters'
  /** Value of missing heights, default none; values that are not finite are missing, too. */
  noData?: number
  /** Factor from the values to metres, default 1 [m]. */
  scale?: number
  /** Height far outside of the grid, default 0 [m]. */
  outside?: number
  /** Distance beyond the edges over which heights blend to `outside`, ≥ 0, default a tenth of the grid's shorter side [m]. */
  fade?: number
  /** Ellipsoid of revolution that the grid lies on, default WGS84. */
  ellipsoid?: Ellipsoid
  /** Line that names the data's source, default ''. */
  attribution?: string
}

const OPTIONS = [
  'width',
  'height',
  'west',
  'east',
  'south',
  'north',
  'units',
  'noData',
  'scale',
  'outside',
  'fade',
  'ellipsoid',
  'attribution'
] as const

const place: GeographicPlace = { longitude: 0, latitude: 0 }
const raster: RasterSample = { value: 0, x: 0, y: 0 }
const cell = { x: 0, y: 0 }

/**
 * Heights of one grid of numbers, such as a digital elevation model, with smooth slopes between them.
 *
 * ```ts
 * const heights = new GridHeights(new Int16Array(await response.arrayBuffer()), {
 *   width: 403, height: 344, west: -84.414, east: -84.078, south: 36.446, north: 36.733
 * })
 * scene.add(new Terrain(atmosphere, heights))
 * ```
 *
 * Coarse pages take averages of 2 × 2 numbers, 4 × 4 and so on; on a grid around the planet as long as these divide the number of columns.
 * Beyond the edges the outermost heights continue and fade to `outside`; holes are filled from their surroundings.
 */
export class GridHeights implements PageSource {
  readonly lowest: number
  readonly highest: number
  /** Line that names the data's source. */
  readonly attribution: string
  readonly #levels: readonly Raster[]
  /** Height of each level at a place in cells of the grid whose sixteen pixels are all there; NaN beside. */
  readonly #insideAt: readonly ((x: number, y: number) => number)[]
  readonly #west: number
  readonly #north: number
  /** True of a grid on the plane of a flat world. */
  readonly #isFlat: boolean
  /** Width of a column and height of a row [rad], or [m] where it is flat. */
  readonly #stepX: number
  readonly #stepY: number
  readonly #radii: Vector3
  /** True if the grid goes around the planet. */
  readonly #wraps: boolean
  readonly #outside: number
  readonly #fade: number
  /** Shorter side of a cell at the middle of the grid [m]. */
  readonly #cell: number
  readonly #slope: number

  /**
   * @param values - Heights row by row from the north-west corner; copied.
   * @throws If an option is missing, unknown or out of its range, or the number of values is another.
   */
  constructor(values: ArrayLike<number>, options: GridHeightsOptions) {
    const where = 'GridHeights'
    checkOptions(where, options, ...OPTIONS)
    const { width, height, west, east, south, north, noData, scale = 1, outside = 0 } = options
    const { ellipsoid = Ellipsoid.WGS84, attribution = '', units = 'degrees' } = options
    if (units !== 'degrees' && units !== 'meters') {
      fail(where, 'units must be degrees or meters', units)
    }
    const isFlat = (this.#isFlat = units === 'meters')
    for (const [name, value] of Object.entries({ width, height })) {
      if (!Number.isInteger(value) || value < 2)
        fail(where, `${name} must be a whole number ≥ 2`, value)
    }
    for (const [name, value] of Object.entries({ west, east, south, north, scale, outside })) {
      checkFinite(where, name, value)
    }
    const [turn, pole] = isFlat ? [Infinity, Infinity] : [360, 90]
    if (!(east > west && east <= west + turn))
      fail(where, `east must be in (west, west + ${turn}]`, east)
    if (!(south >= -pole)) fail(where, `south must be in [−${pole}, ${pole})`, south)
    if (!(north > south && north <= pole)) fail(where, `north must be in (south, ${pole}]`, north)
    if (values?.length !== width * height) {
      fail(where, `values must be ${width * height} numbers`, values?.length)
    }
    checkEllipsoid(where, ellipsoid)
    this.attribution = attribution
    const unit = isFlat ? 1 : MathUtils.DEG2RAD
    this.#west = west * unit
    this.#north = north * unit
    this.#stepX = ((east - west) / width) * unit
    this.#stepY = ((north - south) / height) * unit
    this.#radii = ellipsoid.radii
    this.#wraps = !isFlat && east - west >= 360 - 1e-9
    this.#outside = outside
    const cosineAt = (latitude: number): number =>
      isFlat ? 1 : Math.max(Math.cos(latitude * MathUtils.DEG2RAD), 1e-3)
    const [radius, least] = isFlat ? [1, 1] : [this.#radii.x, ellipsoid.minimumRadius]
    const cellX = this.#stepX * radius * cosineAt((north + south) / 2)
    const cellY = this.#stepY * least
    this.#cell = Math.min(cellX, cellY)
    const { fade = Math.min(cellX * width, cellY * height) / 10 } = options
    checkNonNegative(where, 'fade', fade)
    this.#fade = Math.max(fade, 1)

    // Files of float32 write theirs in decimals, which are not always the same number.
    const missing = Math.fround(noData ?? NaN)
    const numbers = Float32Array.from(values, value =>
      Math.fround(value) === missing ? NaN : value * scale
    )
    let level = fillHoles({ width, height, values: numbers }, outside)
    const levels = [level]
    // Around the planet a level has as many columns as fit: an odd number has no half.
    while (Math.min(level.width, level.height) >= 4 && !(this.#wraps && level.width % 2 === 1)) {
      levels.push((level = halved(level)))
    }
    this.#levels = levels
    this.#insideAt = levels.map(({ width, height, values }, level) => {
      const shrink = 2 ** -level
      return (x, y) => {
        const column = x * shrink - 0.5
        const row = y * shrink - 0.5
        const isInside = column >= 1 && row >= 1 && column < width - 2 && row < height - 2
        return isInside ? valueInside(values, width, column, row) : NaN
      }
    })
    const { low, high, right, down } = boundsOf(levels[0], this.#wraps)
    const over = OVERSHOOT * (high - low)
    this.lowest = Math.min(low - over, outside)
    this.highest = Math.max(high + over, outside)
    // Columns are narrowest at the edge nearer to a pole.
    const narrow = cosineAt(Math.max(Math.abs(north), Math.abs(south)))
    const slopeX = right / (this.#stepX * radius * narrow)
    const fall = (1.5 * (this.highest - this.lowest)) / this.#fade
    this.#slope = STEEPENING * Math.hypot(slopeX, down / cellY) + fall
  }

  /** Rows and columns of the grid. */
  get size(): { width: number; height: number } {
    const { width, height } = this.#levels[0]
    return { width, height }
  }

  variation(distance: number): number {
    return Math.min(this.#slope * distance, this.highest - this.lowest)
  }

  sampleAt(positionECEF: Vector3, target: HeightSample): HeightSample {
    this.#cellOf(positionECEF, cell)
    target.height = this.#sample(cell.x, cell.y, 0, raster).value
    const byLongitude = raster.x / this.#stepX
    const byLatitude = -raster.y / this.#stepY
    if (this.#isFlat) target.gradient.set(byLongitude, 0, -byLatitude)
    else
      geographicGradient(place, byLongitude, byLatitude, positionECEF, this.#radii, target.gradient)
    return target
  }

  loadHeights(request: PageRequest): Float32Array {
    const places = pagePlaces(request, (at, target) => this.#cellOf(at, target), this.#turn)
    const heights = new Float32Array(request.side ** 2)
    if (!this.#fill(heights, request, places)) return heights.fill(this.#outside)
    const radius = this.#isFlat ? 1 : this.#radii.x
    return appendSky(heights, request, i => {
      const [x, y] = [places.x[i], places.y[i]]
      const parallel = this.#isFlat ? 1 : Math.max(Math.cos(this.#north - y * this.#stepY), 1e-3)
      const across = 1 / (this.#stepX * radius * parallel)
      const down = 1 / (this.#stepY * radius)
      return (east, north, detail) => {
        const level = this.#levelOf(detail / 2)
        const [column, row] = [x + east * across, y - north * down]
        const inside = this.#insideAt[level](column, row)
        return Number.isNaN(inside) ? this.#sample(column, row, level, raster).value : inside
      }
    })
  }

  /** Level whose cells are not larger. */
  #levelOf(spacing: number): number {
    const level = Math.floor(Math.log2(spacing / this.#cell))
    return MathUtils.clamp(level, 0, this.#levels.length - 1)
  }

  /** Fills the heights of a page. @returns False if all of it is far outside, and nothing has been filled. */
  #fill(heights: Float32Array, { side, spacing }: PageRequest, places: PagePlaces): boolean {
    const level = this.#levelOf(spacing)
    const { width, values } = this.#levels[level]
    const shrink = 2 ** -level
    const { extent } = places
    const { west, east, north, south } = this.#boundsIn(extent)
    if (
      extent.east <= west ||
      extent.west >= east ||
      extent.south <= north ||
      extent.north >= south
    )
      return false
    const inside = this.#insideAt[level]
    const insideAt = (i: number): number => inside(places.x[i], places.y[i])
    if (fillSmooth(places, side, [shrink, shrink], insideAt, heights)) return true
    const corners = inside(extent.west, extent.north) + inside(extent.east, extent.south)
    if (!Number.isNaN(corners)) {
      fillInside(values, width, places, { scale: [shrink, shrink], first: [0, 0] }, heights)
      return true
    }
    for (let i = 0; i < heights.length; i++) {
      const x = places.x[i]
      const y = places.y[i]
      if (x <= west || x >= east || y <= north || y >= south) heights[i] = this.#outside
      else {
        const height = inside(x, y)
        heights[i] = Number.isNaN(height) ? this.#sample(x, y, level, raster).value : height
      }
    }
    return true
  }

  /** Bounds, among places of an extent, beyond which `outside` is the height [cells]. */
  #boundsIn({ north, south }: Extent): Extent {
    const { width, height } = this.#levels[0]
    const [longest, parallel] = this.#isFlat
      ? [1, () => 1]
      : [this.#radii.x, (y: number): number => Math.cos(this.#north - y * this.#stepY)]
    const rows = this.#fade / this.#stepY / longest
    const narrowest = longest * Math.max(Math.min(parallel(north), parallel(south)), 1e-9)
    const columns = this.#fade / this.#stepX / narrowest
    return { west: -columns, east: width + columns, north: -rows, south: height + rows }
  }

  /** Columns of a whole turn about the planet. */
  get #turn(): number {
    return this.#isFlat ? Infinity : (2 * Math.PI) / this.#stepX
  }

  /** Place in cells from the outer edges; of longitudes a turn apart the one nearest to the middle. */
  #cellOf(positionECEF: Vector3, target: { x: number; y: number }): void {
    if (this.#isFlat) {
      target.x = (positionECEF.x - this.#west) / this.#stepX
      target.y = (positionECEF.z + this.#north) / this.#stepY
      return
    }
    geographicPlace(positionECEF, this.#radii, place)
    const x = (place.longitude - this.#west) / this.#stepX
    const turns = Math.round((x - this.#levels[0].width / 2) / this.#turn)
    target.x = x - turns * this.#turn
    target.y = (this.#north - place.latitude) / this.#stepY
  }

  /**
   * Height at a place and its slopes per cell of the grid.
   *
   * @param x - In cells from the outer edges, like `y`.
   */
  #sample(x: number, y: number, level: number, target: RasterSample): RasterSample {
    const { width, height } = this.#levels[0]
    const insideX = MathUtils.clamp(x, 0, width)
    const insideY = MathUtils.clamp(y, 0, height)
    const isInside = insideX === x && insideY === y
    const isFlat = this.#isFlat
    const tall = this.#stepY * (isFlat ? 1 : this.#radii.x)
    const down = (y - insideY) * tall
    const isFar = Math.abs(down) >= this.#fade
    const parallel =
      isFlat || isInside || isFar ? 1 : this.#radii.x * Math.cos(this.#north - y * this.#stepY)
    const wide = this.#stepX * parallel
    const distance = isInside ? 0 : Math.hypot((x - insideX) * wide, down)
    if (isFar || distance >= this.#fade) {
      target.value = this.#outside
      target.x = target.y = 0
      return target
    }
    const grid = this.#levels[level]
    const shrink = 2 ** -level
    const pixelAt = (column: number, row: number): number => {
      const inRow = this.#wraps
        ? (column + grid.width) % grid.width
        : MathUtils.clamp(column, 0, grid.width - 1)
      return grid.values[MathUtils.clamp(row, 0, grid.height - 1) * grid.width + inRow]
    }
    sampleRaster(pixelAt, insideX * shrink - 0.5, insideY * shrink - 0.5, target)
    target.x *= shrink
    target.y *= shrink
    if (distance === 0) return target
    // Blend to the height outside.
    const t = distance / this.#fade
    const kept = 1 - t * t * (3 - 2 * t)
    const fall = (-6 * t * (1 - t)) / this.#fade / distance
    const over = target.value - this.#outside
    target.x = (insideX === x ? target.x * kept : 0) + over * fall * (x - insideX) * wide ** 2
    target.y = (insideY === y ? target.y * kept : 0) + over * fall * (y - insideY) * tall ** 2
    target.value = this.#outside + over * kept
    return target
  }
}
