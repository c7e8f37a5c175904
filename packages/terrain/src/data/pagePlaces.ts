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
  /** Bounds of the coordinates. */
  readonly extent: Extent
}

/** Least and greatest coordinates on a map. */
export interface Extent {
  readonly west: number
  readonly east: number
  readonly north: number
  readonly south: number
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
  placeOf(side >> 1, side >> 1, position)
  const axis = Math.max(Math.hypot(position.x, position.y) - side * spacing, 0)
  const tolerance = Math.max(TOLERANCE, TOLERANCE_OF_STEP * spacing)
  if ((BLOCK * spacing) ** 4 < 2 * tolerance * axis ** 3) {
    const weights = cubicWeights(side, BLOCK)
    const { nodes } = weights
    const nodesX = new Float64Array(nodes.length ** 2)
    const nodesY = new Float64Array(nodesX.length)
    let isWhole = true
    let n = 0
    for (const row of nodes) {
      for (const column of nodes) {
        project(placeOf(column, row, position), at)
        nodesX[n] = at.x
        nodesY[n] = at.y
        isWhole &&= Math.abs(at.x - nodesX[0]) < period / 2
        n++
      }
    }
    if (isWhole) {
      interpolate(nodesX, weights, x)
      interpolate(nodesY, weights, y)
      // Between exact places others are less than a step beyond them.
      return { x, y, isSmooth: true, extent: extentOf(nodesX, nodesY, 1 / (side - 1)) }
    }
  }
  for (let n = 0; n < x.length; n++) {
    const row = Math.floor(n / side)
    project(placeOf(n - row * side, row, position), at)
    x[n] = at.x
    y[n] = at.y
  }
  return { x, y, isSmooth: false, extent: extentOf(x, y, 0) }
}

/** @param more - Part of their range by which they are widened. */
function extentOf(x: Float64Array, y: Float64Array, more: number): Extent {
  let [west, east, north, south] = [Infinity, -Infinity, Infinity, -Infinity]
  for (let i = 0; i < x.length; i++) {
    if (x[i] < west) west = x[i]
    if (x[i] > east) east = x[i]
    if (y[i] < north) north = y[i]
    if (y[i] > south) south = y[i]
  }
  const [wide, tall] = [more * (east - west), more * (south - north)]
  return { west: west - wide, east: east + wide, north: north - tall, south: south + tall }
}

/** Steps of a page's heights per pixel of the data in the way between heights that are found exactly: a twelfth. */
const FINENESS = 12

/**
 * Heights of a page: where its steps are much smaller than pixels of the data those of every so many are found, and the others by cubic interpolation,
 * within a thousandth of the differences of neighbouring pixels.
 *
 * @param width - Pixels per unit of `x`, `height` per unit of `y`.
 * @param heightAt - Height of a place by its number; NaN beside smooth data.
 * @returns False if there is one, and nothing has been filled.
 */
export function fillSmooth(
  { x, y, isSmooth }: PagePlaces,
  side: number,
  [width, height]: readonly [number, number],
  heightAt: (place: number) => number,
  heights: Float32Array
): boolean {
  const middle = (side * side) >> 1
  const pixels = (next: number): number =>
    Math.max(
      Math.abs(x[middle + next] - x[middle]) * width,
      Math.abs(y[middle + next] - y[middle]) * height
    )
  const stride = Math.min(Math.floor(1 / FINENESS / Math.max(pixels(1), pixels(side))), BLOCK)
  if (!isSmooth || stride < 2) return false
  const weights = cubicWeights(side, stride)
  const { nodes } = weights
  const values = new Float64Array(nodes.length ** 2)
  let n = 0
  for (const row of nodes) {
    for (const column of nodes) {
      const value = heightAt(row * side + column)
      if (Number.isNaN(value)) return false
      values[n++] = value
    }
  }
  interpolate(values, weights, heights)
  return true
}

/** Weights of four nodes at each of `side` places, and the first of these nodes (Lagrange). */
interface Weights {
  readonly side: number
  readonly nodes: readonly number[]
  readonly first: Int32Array
  readonly weights: Float64Array
}

/** Weights by the places from a node to the next, for pages of the side that was asked for last. */
let made: Weights[] = []

/** @param step - Places from a node to the next; the last is at the end. */
function cubicWeights(side: number, step: number): Weights {
  if (made.find(Boolean)?.side !== side) made = []
  return (made[step] ??= makeWeights(side, Math.min(step, Math.floor((side - 1) / 3))))
}

function makeWeights(side: number, stride: number): Weights {
  const nodes: number[] = []
  for (let i = 0; i < side - 1; i += stride) nodes.push(i)
  nodes.push(side - 1)
  const first = new Int32Array(side)
  const weights = new Float64Array(4 * side)
  for (let i = 0; i < side; i++) {
    const block = Math.min(Math.max(Math.floor(i / stride) - 1, 0), nodes.length - 4)
    first[i] = block
    const four = nodes.slice(block, block + 4)
    for (const [k, node] of four.entries()) {
      weights[4 * i + k] = four.reduce(
        (product, other) => (other === node ? product : (product * (i - other)) / (node - other)),
        1
      )
    }
  }
  return { side, nodes, first, weights }
}

/** Fills a square by the nodes of a coarser one: along their rows, then between these. */
function interpolate(
  values: Float64Array,
  { side, nodes, first, weights }: Weights,
  target: Float64Array | Float32Array
): void {
  const count = nodes.length
  const rows = new Float64Array(count * side)
  for (let row = 0, n = 0; row < count; row++) {
    for (let i = 0, w = 0; i < side; i++, w += 4) {
      const at = row * count + first[i]
      rows[n++] =
        weights[w] * values[at] +
        weights[w + 1] * values[at + 1] +
        weights[w + 2] * values[at + 2] +
        weights[w + 3] * values[at + 3]
    }
  }
  for (let row = 0, n = 0; row < side; row++) {
    const w = 4 * row
    const [a, b, c, d] = [weights[w], weights[w + 1], weights[w + 2], weights[w + 3]]
    for (let i = 0, at = first[row] * side; i < side; i++, at++) {
      target[n++] =
        a * rows[at] + b * rows[at + side] + c * rows[at + 2 * side] + d * rows[at + 3 * side]
    }
  }
}
