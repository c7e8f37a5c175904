import { readFileSync } from 'node:fs'
import { gunzipSync } from 'node:zlib'
import { fractalNoise } from './noise.ts'

interface Figures {
  rows: number
  columns: number
  west: number
  east: number
  south: number
  north: number
}

/** The apron ends this far below the ellipsoid, out of sight under the globe [m]. */
const APRON_FLOOR = -60

/**
 * A regular grid of heights with a made-up apron around the measured ones.
 *
 * The measured rectangle stands 236–1076 m above the ellipsoid, on which the globe's own surface lies. Cut off, it
 * would be a table with cliffs; the apron continues its edges as hills that sink into the globe.
 */
export class Elevation {
  readonly heights: Float64Array

  private constructor(
    readonly figures: Figures,
    private readonly measured: Int16Array,
    /** Cells along a side of the square grid; it has one more vertex than cells. */
    readonly cells: number
  ) {
    this.rowPad = Math.floor((cells - figures.rows) / 2)
    this.columnPad = Math.floor((cells - figures.columns) / 2)
    this.stepLatitude = (figures.north - figures.south) / figures.rows
    this.stepLongitude = (figures.east - figures.west) / figures.columns
    const size = cells + 1
    this.heights = new Float64Array(size * size)
    for (let row = 0; row < size; row++) {
      for (let column = 0; column < size; column++) {
        this.heights[row * size + column] = this.extended(
          row - this.rowPad,
          column - this.columnPad
        )
      }
    }
  }

  private readonly rowPad: number
  private readonly columnPad: number
  readonly stepLatitude: number
  readonly stepLongitude: number

  static read(directory: URL, cells: number): Elevation {
    const figures = JSON.parse(
      readFileSync(new URL('jacksboro-dem.json', directory), 'utf8')
    ) as Figures
    const bytes = gunzipSync(readFileSync(new URL('jacksboro-dem.i16.gz', directory)))
    const count = figures.rows * figures.columns
    if (bytes.length !== count * 2) {
      throw new Error(`Elevation: expected ${count * 2} bytes, got ${bytes.length}`)
    }
    const measured = new Int16Array(count)
    for (let i = 0; i < count; i++) {
      measured[i] = bytes.readInt16LE(i * 2)
    }
    return new Elevation(figures, measured, cells)
  }

  /** Latitude of a grid row, fractions allowed [degrees]. A sample is the centre of its cell. */
  latitude(row: number): number {
    return this.figures.north - (row - this.rowPad + 0.5) * this.stepLatitude
  }

  /** Longitude of a grid column, fractions allowed [degrees]. */
  longitude(column: number): number {
    return this.figures.west + (column - this.columnPad + 0.5) * this.stepLongitude
  }

  rowAt(latitude: number): number {
    return (this.figures.north - latitude) / this.stepLatitude + this.rowPad - 0.5
  }

  columnAt(longitude: number): number {
    return (longitude - this.figures.west) / this.stepLongitude + this.columnPad - 0.5
  }

  /** Height of a vertex of the grid [m]. */
  at(row: number, column: number): number {
    const size = this.cells + 1
    const clampedRow = Math.min(Math.max(row, 0), this.cells)
    const clampedColumn = Math.min(Math.max(column, 0), this.cells)
    return this.heights[clampedRow * size + clampedColumn]
  }

  /** Height on the triangles of a tile that has a vertex every `step` samples [m]. */
  onTriangles(row: number, column: number, step = 1): number {
    const row0 = Math.min(Math.floor(row / step), this.cells / step - 1) * step
    const column0 = Math.min(Math.floor(column / step), this.cells / step - 1) * step
    const y = (row - row0) / step
    const x = (column - column0) / step
    const northWest = this.at(row0, column0)
    const northEast = this.at(row0, column0 + step)
    const southWest = this.at(row0 + step, column0)
    const southEast = this.at(row0 + step, column0 + step)
    return x + y <= 1
      ? northWest + x * (northEast - northWest) + y * (southWest - northWest)
      : southEast + (1 - x) * (southWest - southEast) + (1 - y) * (northEast - southEast)
  }

  /** 0 on measured ground, to 1 at the end of the apron. */
  outside(row: number, column: number): number {
    const { rows, columns } = this.figures
    const rowsOut = Math.max(this.rowPad - row, row - this.rowPad - (rows - 1), 0)
    const columnsOut = Math.max(this.columnPad - column, column - this.columnPad - (columns - 1), 0)
    return Math.min(Math.hypot(rowsOut / (this.rowPad - 2), columnsOut / (this.columnPad - 2)), 1)
  }

  private extended(row: number, column: number): number {
    const { rows, columns } = this.figures
    const rowsOut = Math.max(-row, row - (rows - 1), 0)
    const columnsOut = Math.max(-column, column - (columns - 1), 0)
    if (rowsOut === 0 && columnsOut === 0) {
      return this.measured[row * columns + column]
    }
    const outside = this.outside(row + this.rowPad, column + this.columnPad)
    // Averaging over a window that grows with distance keeps the edge from being drawn out into streaks.
    const window = Math.round(Math.hypot(rowsOut, columnsOut) * 0.5)
    const edge = this.average(row, column, window)
    const hills = (fractalNoise(row / 22, column / 22, 4) - 0.5) * 260 * outside * (1 - outside) * 4
    const fall = outside * outside * (3 - 2 * outside)
    return (edge + hills) * (1 - fall) + APRON_FLOOR * fall
  }

  private average(row: number, column: number, window: number): number {
    const { rows, columns } = this.figures
    const stride = Math.max(1, Math.floor(window / 4))
    let sum = 0
    let count = 0
    for (let y = -window; y <= window; y += stride) {
      for (let x = -window; x <= window; x += stride) {
        const sampleRow = Math.min(Math.max(row + y, 0), rows - 1)
        const sampleColumn = Math.min(Math.max(column + x, 0), columns - 1)
        sum += this.measured[sampleRow * columns + sampleColumn]
        count++
      }
    }
    return sum / count
  }
}
