import { Vector3 } from 'three'
import type { PageRequest } from '../pages/PageSource'

/** Steps between places that are projected exactly. */
const BLOCK = 10

/** Longest distance of exact places between which the others are interpolated: within 0.1 m at 45° of latitude and 0.5 m at 80° [m]. */
const LONGEST = 2000

/** Sine of the latitude up to which places between exact ones are interpolated [–]. */
const LINEAR_TO = 0.98

/** Coordinates of a page's places on a map. */
export interface PagePlaces {
  readonly x: Float64Array
  readonly y: Float64Array
}

const position = new Vector3()

/**
 * Places of a page on a map.
 *
 * @param project - Leaves the map's coordinates of a place on the ellipsoid in `x` and `y` of the target.
 * @param period - Width of the map, at which columns jump.
 */
export function pagePlaces(
  { side, spacing, placeOf }: PageRequest,
  project: (positionECEF: Vector3, target: { x: number; y: number }) => void,
  period: number
): PagePlaces {
  const x = new Float64Array(side * side)
  const y = new Float64Array(side * side)
  const at = { x: 0, y: 0 }
  const put = (column: number, row: number): void => {
    project(placeOf(column, row, position), at)
    x[row * side + column] = at.x
    y[row * side + column] = at.y
  }
  const nodes: number[] = []
  for (let i = 0; i < side - 1; i += BLOCK) nodes.push(i)
  nodes.push(side - 1)
  placeOf(side >> 1, side >> 1, position)
  let isLinear = BLOCK * spacing < LONGEST && Math.abs(position.z) < LINEAR_TO * position.length()
  if (isLinear) {
    for (const row of nodes) for (const column of nodes) put(column, row)
    const first = x[0]
    isLinear = nodes.every(row =>
      nodes.every(column => Math.abs(x[row * side + column] - first) < period / 2)
    )
  }
  if (!isLinear) {
    for (let row = 0; row < side; row++)
      for (let column = 0; column < side; column++) put(column, row)
    return { x, y }
  }
  for (const values of [x, y]) {
    // Along the rows of nodes first, then between these rows.
    for (const row of nodes) spread(values, row * side, 1, nodes)
    for (let column = 0; column < side; column++) spread(values, column, side, nodes)
  }
  return { x, y }
}

/** Fills a line linearly between its nodes. */
function spread(
  values: Float64Array,
  start: number,
  stride: number,
  nodes: readonly number[]
): void {
  for (let n = 1; n < nodes.length; n++) {
    const [from, to] = [nodes[n - 1], nodes[n]]
    const first = values[start + from * stride]
    const step = (values[start + to * stride] - first) / (to - from)
    for (let i = from + 1; i < to; i++) values[start + i * stride] = first + step * (i - from)
  }
}
