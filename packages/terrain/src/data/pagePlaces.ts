import { Vector3 } from 'three'
import type { PageRequest } from '../pages/PageSource'

/** Steps between places that are projected exactly, at most. */
const BLOCK = 12

/** Greatest error of a place between exact ones: so much [m], or so much of a page's steps [–]. */
const TOLERANCE = 1e-3
const TOLERANCE_OF_STEP = 1e-4

/** Coordinates of a page's places on a map. */
export interface PagePlaces {
  readonly x: Float64Array
  readonly y: Float64Array
  /** True where places are interpolated. */
  readonly isSmooth: boolean
}

const position = new Vector3()
const at = { x: 0, y: 0 }
/** Arrays that all pages share: they are read before the next is asked for. */
let x = new Float64Array(0)
let y = new Float64Array(0)

/**
 * Places of a page on a map, in arrays that the next call fills anew: cubic interpolation of exact ones, to 1 mm or a ten-thousandth
 * of its steps, where the page is not too large for it, or too near a pole.
 *
 * With h the distance of exact places and ρ that of the page to the planet's axis, the error is at most h⁴ / 2ρ³: the fourth derivative of longitude is
 * about 6 / ρ⁴, a 24th of which counts between the outermost of four nodes, twice for both directions.
 *
 * @param project - Leaves the map's coordinates of a place on the ellipsoid in `x` and `y` of the target.
 * @param period - Width of the map, at which columns jump.
 */
export function pagePlaces(
  { side, spacing, placeOf }: PageRequest,
  project: (positionECEF: Vector3, target: { x: number; y: number }) => void,
  period: number
): PagePlaces {
  if (x.length !== side * side) {
    x = new Float64Array(side * side)
    y = new Float64Array(side * side)
  }
  const blocks = Math.max(Math.ceil((side - 1) / BLOCK), 3)
  const step = (side - 1) / blocks
  placeOf(side >> 1, side >> 1, position)
  const axis = Math.max(Math.hypot(position.x, position.y) - side * spacing, 0)
  const tolerance = Math.max(TOLERANCE, TOLERANCE_OF_STEP * spacing)
  if ((step * spacing) ** 4 < 2 * tolerance * axis ** 3) {
    const nodesX = new Float64Array((blocks + 1) ** 2)
    const nodesY = new Float64Array(nodesX.length)
    let isWhole = true
    for (let n = 0; n < nodesX.length; n++) {
      const row = Math.floor(n / (blocks + 1))
      project(placeOf((n - row * (blocks + 1)) * step, row * step, position), at)
      nodesX[n] = at.x
      nodesY[n] = at.y
      isWhole &&= Math.abs(at.x - nodesX[0]) < period / 2
    }
    if (isWhole) {
      const weights = cubicWeights(side, blocks)
      interpolate(nodesX, weights, x)
      interpolate(nodesY, weights, y)
      return { x, y, isSmooth: true }
    }
  }
  for (let n = 0; n < x.length; n++) {
    const row = Math.floor(n / side)
    project(placeOf(n - row * side, row, position), at)
    x[n] = at.x
    y[n] = at.y
  }
  return { x, y, isSmooth: false }
}

/** Weights of four nodes at each of `side` places, and the first of these nodes (Lagrange). */
interface Weights {
  readonly side: number
  readonly nodes: number
  readonly first: Int32Array
  readonly weights: Float64Array
}

function cubicWeights(side: number, blocks: number): Weights {
  const first = new Int32Array(side)
  const weights = new Float64Array(4 * side)
  for (let i = 0; i < side; i++) {
    const along = (i * blocks) / (side - 1)
    first[i] = Math.min(Math.max(Math.floor(along) - 1, 0), blocks - 3)
    const t = along - first[i]
    const [a, b, c] = [t - 1, t - 2, t - 3]
    weights.set([(-a * b * c) / 6, (t * b * c) / 2, (-t * a * c) / 2, (t * a * b) / 6], 4 * i)
  }
  return { side, nodes: blocks + 1, first, weights }
}

/** Fills a square by the nodes of a coarser one: along their rows, then between these. */
function interpolate(
  values: Float64Array,
  { side, nodes, first, weights }: Weights,
  target: Float64Array
): void {
  const rows = new Float64Array(nodes * side)
  const blend = (from: Float64Array, n: number, stride: number, i: number): number =>
    weights[4 * i] * from[n] +
    weights[4 * i + 1] * from[n + stride] +
    weights[4 * i + 2] * from[n + 2 * stride] +
    weights[4 * i + 3] * from[n + 3 * stride]
  for (let n = 0; n < rows.length; n++) {
    const row = Math.floor(n / side)
    const i = n - row * side
    rows[n] = blend(values, row * nodes + first[i], 1, i)
  }
  for (let row = 0, n = 0; row < side; row++) {
    const start = first[row] * side
    for (let i = 0; i < side; i++) target[n++] = blend(rows, start + i, side, row)
  }
}
