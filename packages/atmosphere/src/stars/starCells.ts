import { octahedralDirection, octahedralPoint } from './octahedron'
import type { Star } from './starCode'

/** Cells of the sky for stars whose pictures have a size. */
export interface StarLevel {
  /** Cells along an edge of the octahedral map. */
  readonly cells: number
  /** Cells that a star may shine into from outside of them are within this angle of it [rad]. */
  readonly reach: number
}

/** For pictures of stars as small as most cameras make them, and for large ones. */
export const STAR_LEVELS = [
  { cells: 128, reach: 0.004 },
  { cells: 64, reach: 0.024 }
] as const satisfies readonly StarLevel[]

/** Columns of the texture that the cells' stars are kept in, a power of two. */
export const ENTRY_COLUMNS = 256

/** Magnitudes are stored as a fraction of this range. */
export const MAGNITUDE_RANGE = { min: -4, span: 32 } as const

/** Colours are stored as whole steps of B − V. */
export const COLOR_STEPS = { min: -0.4, step: 0.1, count: 25 } as const

/**
 * A star's magnitude and colour in one number: the step of B − V, and as its fraction the magnitude.
 */
export function packStar({ magnitude, colorIndex }: Star): number {
  const step = Math.round((colorIndex - COLOR_STEPS.min) / COLOR_STEPS.step)
  const fraction = (magnitude - MAGNITUDE_RANGE.min) / MAGNITUDE_RANGE.span
  return (
    Math.min(Math.max(step, 0), COLOR_STEPS.count - 1) + Math.min(Math.max(fraction, 0), 0.99999)
  )
}

/** Unit vector of a star in the frame of J2000. */
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

/** Half-spaces, as (normal, least dot product), that hold all that is within `reach` of a cell. */
type Bounds = (readonly [normal: readonly number[], least: number])[]

function boundCell({ cells, reach }: StarLevel, cell: number): Bounds {
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
    // The map is folded along its diagonal: no point of it is farther from its middle than a corner.
    const radius = Math.max(...corners.map(corner => Math.acos(Math.min(dot(middle, corner), 1))))
    return [[middle, Math.cos(radius + reach)]]
  }
  // Its edges are great circles.
  return corners.map((corner, i) => {
    const normal = unit(cross(corner, corners[(i + 1) % 4]))
    const inwards = normal.map(value => value * Math.sign(dot(normal, middle)))
    return [inwards, -Math.sin(reach)] as const
  })
}

/** The four cells that share an edge with one; those at the map's edges meet others there. */
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

/** Numbers of the stars that can shine into each cell. */
function starsByCell(level: StarLevel, directions: readonly (readonly number[])[]): number[][] {
  const { cells } = level
  const lists: number[][] = Array.from({ length: cells * cells }, () => [])
  const bounds: Bounds[] = []
  directions.forEach((direction, star) => {
    const [column, row] = octahedralPoint(direction).map(x =>
      Math.min(Math.floor(((x + 1) / 2) * cells), cells - 1)
    )
    const waiting = [row * cells + column]
    const seen = new Set(waiting)
    // Spreads from the star's own cell: what a circle touches is connected.
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

/** Textures that say which stars can shine where. */
export interface StarCells {
  /**
   * Texels (first entry, number of entries) of the cells, those of the first of {@link STAR_LEVELS} in the
   * first rows, and as wide.
   */
  cells: Float32Array<ArrayBuffer>
  /** Texels (unit vector, {@link packStar}), {@link ENTRY_COLUMNS} wide. */
  entries: Float32Array<ArrayBuffer>
}

/** Sorts stars into cells. The unit vectors are in the frame of J2000. */
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
