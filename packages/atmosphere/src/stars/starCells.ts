import { octahedralDirection, octahedralPoint } from '../math/cpu/octahedron'
import type { Star } from './starEncoding'

/** Grid of cells on the sky, for stars' images up to some size. */
export interface StarLevel {
  /** Cells along an edge of the octahedral map. */
  readonly cells: number
  /** Angle around a cell within which stars belong to it: the radius of a star's image [rad]. */
  readonly margin: number
}

/** Small cells for the small star images of most cameras, large cells for large images. */
export const STAR_LEVELS = [
  { cells: 128, margin: 0.004 },
  { cells: 64, margin: 0.024 }
] as const satisfies readonly StarLevel[]

/** Width of the texture of entries, a power of two [texels]. */
export const ENTRY_COLUMNS = 256

/** Range of magnitudes that an entry can hold. */
export const MAGNITUDE_RANGE = { min: -4, span: 32 } as const

/** Steps of B − V that an entry can hold. */
export const COLOR_STEPS = { min: -0.4, step: 0.1, count: 25 } as const

/** Magnitude and colour of a star in one number: the step of B − V plus the magnitude as a fraction. */
export function packStar({ magnitude, colorIndex }: Star): number {
  const step = Math.round((colorIndex - COLOR_STEPS.min) / COLOR_STEPS.step)
  const fraction = (magnitude - MAGNITUDE_RANGE.min) / MAGNITUDE_RANGE.span
  return (
    Math.min(Math.max(step, 0), COLOR_STEPS.count - 1) + Math.min(Math.max(fraction, 0), 0.99999)
  )
}

/** Direction to a star, frame of J2000, unit length. */
export function starDirection({ ascension, declination }: Star): [number, number, number] {
  const level = Math.cos(declination)
  return [level * Math.cos(ascension), level * Math.sin(ascension), Math.sin(declination)]
}

const dot = (a: readonly number[], b: readonly number[]): number =>
  a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

const cross = (a: readonly number[], b: readonly number[]): number[] => [
  a[1] * b[2] - a[2] * b[1],
  a[2] * b[0] - a[0] * b[2],
  a[0] * b[1] - a[1] * b[0]
]

const unit = (v: readonly number[]): number[] => {
  const length = Math.hypot(...v)
  return v.map(value => value / length)
}

/** Half-spaces (normal, least dot product) whose intersection holds a cell and its margin. */
type CellBounds = (readonly [normal: readonly number[], least: number])[]

/** Bounds of a cell with its margin. */
function boundCell({ cells, margin }: StarLevel, cell: number): CellBounds {
  const at = (i: number): number => (2 * i) / cells - 1
  const [column, row] = [cell % cells, Math.floor(cell / cells)]
  const corners = [
    [0, 0],
    [1, 0],
    [1, 1],
    [0, 1]
  ].map(([x, y]) => unit(octahedralDirection(at(column + x), at(row + y))))
  const middle = unit(octahedralDirection(at(column + 0.5), at(row + 0.5)))
  const fold = Math.abs(at(column + 0.5)) + Math.abs(at(row + 0.5))
  if (Math.abs(fold - 1) < 0.5 / cells) {
    // On the map's fold a cell is not convex: a circle through its farthest corner bounds it.
    const radius = Math.max(...corners.map(corner => Math.acos(Math.min(dot(middle, corner), 1))))
    return [[middle, Math.cos(radius + margin)]]
  }
  // Its edges are great circles.
  return corners.map((corner, i) => {
    const normal = unit(cross(corner, corners[(i + 1) % 4]))
    const inwards = normal.map(value => value * Math.sign(dot(normal, middle)))
    return [inwards, -Math.sin(margin)] as const
  })
}

/** Four neighbours of a cell, across the folded edges of the map too. */
function neighbours({ cells }: StarLevel, cell: number): number[] {
  const [column, row] = [cell % cells, Math.floor(cell / cells)]
  const last = cells - 1
  const at = (x: number, y: number): number => {
    if (x < 0 || x > last) return at(Math.min(Math.max(x, 0), last), last - y)
    if (y < 0 || y > last) return at(last - x, Math.min(Math.max(y, 0), last))
    return y * cells + x
  }
  return [at(column - 1, row), at(column + 1, row), at(column, row - 1), at(column, row + 1)]
}

/** Indices of the stars in each cell and its margin. */
function starsByCell(level: StarLevel, directions: readonly (readonly number[])[]): number[][] {
  const { cells } = level
  const lists: number[][] = Array.from({ length: cells * cells }, () => [])
  const bounds: CellBounds[] = []
  directions.forEach((direction, star) => {
    const [column, row] = octahedralPoint(direction).map(x =>
      Math.min(Math.floor(((x + 1) / 2) * cells), cells - 1)
    )
    const waiting = [row * cells + column]
    const seen = new Set(waiting)
    // Flood fill from the star's own cell: the cells that a circle touches are connected.
    for (let cell = waiting.pop(); cell !== undefined; cell = waiting.pop()) {
      bounds[cell] ??= boundCell(level, cell)
      if (bounds[cell].some(([normal, least]) => dot(normal, direction) < least)) continue
      lists[cell].push(star)
      for (const next of neighbours(level, cell)) {
        if (!seen.has(next)) waiting.push(next)
        seen.add(next)
      }
    }
  })
  return lists
}

/** Texels of the stars sorted by cell. */
export interface StarCells {
  /**
   * Texels (first entry, number of entries), as wide as the first of {@link STAR_LEVELS}, whose rows come
   * first.
   */
  cells: Float32Array<ArrayBuffer>
  /** Texels (unit vector, {@link packStar}), {@link ENTRY_COLUMNS} wide. */
  entries: Float32Array<ArrayBuffer>
}

/** Stars sorted into cells, with unit vectors in the frame of J2000. */
export function starCells(stars: readonly Star[]): StarCells {
  const directions = stars.map(starDirection)
  const levels = STAR_LEVELS.map(level => starsByCell(level, directions))
  const width = STAR_LEVELS[0].cells
  const cells = new Float32Array(2 * width * STAR_LEVELS.reduce((sum, { cells }) => sum + cells, 0))
  const total = levels.flat().reduce((sum, list) => sum + list.length, 0)
  const rows = Math.max(Math.ceil(total / ENTRY_COLUMNS), 1)
  const entries = new Float32Array(4 * ENTRY_COLUMNS * rows)
  let [top, next] = [0, 0]
  levels.forEach((lists, level) => {
    const size = STAR_LEVELS[level].cells
    lists.forEach((list, cell) => {
      const texel = (top + Math.floor(cell / size)) * width + (cell % size)
      cells.set([next, list.length], 2 * texel)
      for (const star of list) entries.set([...directions[star], packStar(stars[star])], 4 * next++)
    })
    top += size
  })
  return { cells, entries }
}
