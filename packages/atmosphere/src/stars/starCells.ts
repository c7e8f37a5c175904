import type { Star } from './starCode'

/** Cells along an edge of a face of the cube; a face has this number squared. */
export const CELLS = 32

/** Cells that a star may shine into from outside of them are within this angle of it [rad]. */
export const STAR_REACH = 0.024

/** Columns of the texture that the cells and their stars are kept in. */
export const CELL_COLUMNS = 256

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

/** Axes of a face of the cube: the one through it, and those of its two coordinates. */
export const faceAxes = (face: number): [number, number, number] => {
  const axis = face >> 1
  return [axis, (axis + 1) % 3, (axis + 2) % 3]
}

/** Direction, not of unit length, of a point of a face; coordinates in [−1, 1], equal in angle. */
function facePoint(face: number, s: number, t: number): [number, number, number] {
  const [major, first, second] = faceAxes(face)
  const direction: [number, number, number] = [0, 0, 0]
  direction[major] = face & 1 ? -1 : 1
  direction[first] = Math.tan((Math.PI / 4) * s)
  direction[second] = Math.tan((Math.PI / 4) * t)
  return direction
}

const dot = (a: readonly number[], b: readonly number[]): number =>
  a[0] * b[0] + a[1] * b[1] + a[2] * b[2]

const unit = (v: readonly number[]): number[] => {
  const length = Math.hypot(...v)
  return v.map(value => value / length)
}

/** Cosines between the middle of a cell and what lies {@link STAR_REACH} beyond its farthest corner. */
function boundCell(face: number, column: number, row: number) {
  const at = (i: number): number => (2 * i) / CELLS - 1
  const middle = unit(facePoint(face, at(column + 0.5), at(row + 0.5)))
  const corners = [0, 1, 2, 3].map(corner =>
    unit(facePoint(face, at(column + (corner & 1)), at(row + (corner >> 1))))
  )
  // A cell's edges are great circles: no point of it is farther from the middle than a corner.
  const radius = Math.max(...corners.map(corner => Math.acos(Math.min(dot(middle, corner), 1))))
  return { middle, cosReach: Math.cos(radius + STAR_REACH) }
}

/**
 * Which stars can shine into which cell of a cube around the observer, as texels of a float texture
 * {@link CELL_COLUMNS} wide: first a texel per cell, (its first entry's texel, number of entries, 0, 0);
 * then the entries, (unit vector, {@link packStar}).
 */
export function starCells(stars: readonly Star[]): Float32Array<ArrayBuffer> {
  const cells: number[][] = []
  const bounds: ReturnType<typeof boundCell>[] = []
  for (let face = 0; face < 6; face++) {
    for (let row = 0; row < CELLS; row++) {
      for (let column = 0; column < CELLS; column++) {
        cells.push([])
        bounds.push(boundCell(face, column, row))
      }
    }
  }
  const directions = stars.map(starDirection)
  directions.forEach((direction, star) => {
    for (let face = 0; face < 6; face++) {
      const [major, first, second] = faceAxes(face)
      const depth = direction[major] * (face & 1 ? -1 : 1)
      // Beyond 55° + reach from the middle of a face there is none of its cells.
      if (depth < 0.5) continue
      // A cell's width more than needed on either side: the exact test follows.
      const near = [first, second].map(axis => {
        const s = (Math.atan(direction[axis] / depth) / (Math.PI / 4) + 1) * (CELLS / 2)
        return [Math.max(Math.floor(s) - 2, 0), Math.min(Math.floor(s) + 2, CELLS - 1)]
      })
      for (let row = near[1][0]; row <= near[1][1]; row++) {
        for (let column = near[0][0]; column <= near[0][1]; column++) {
          const cell = (face * CELLS + row) * CELLS + column
          if (dot(bounds[cell].middle, direction) >= bounds[cell].cosReach) cells[cell].push(star)
        }
      }
    }
  })
  const entries = cells.reduce((sum, list) => sum + list.length, 0)
  const rows = Math.ceil((cells.length + entries) / CELL_COLUMNS)
  const texels = new Float32Array(4 * rows * CELL_COLUMNS)
  let next = cells.length
  cells.forEach((list, cell) => {
    texels.set([next, list.length], 4 * cell)
    for (const star of list) texels.set([...directions[star], packStar(stars[star])], 4 * next++)
  })
  return texels
}
