import type { Ellipsoid } from '@welkin/geo'
import { Vector3 } from 'three'
import { cubeToEllipsoid, faceAxes } from '../src/tiles/cpu/cubeSphere'
import type { Tile } from '../src/tiles/Tile'
import { DEEPEST_SKIRT, FLAT, morphStart, SKIRT_WIDTH } from '../src/tiles/tsl/tileVertex'

/** Properties that all tiles of a drawing share. ECEF [m]. */
export interface Drawing {
  readonly ellipsoid: Ellipsoid
  readonly eye: Vector3
  /** Point from which distances to tiles count. */
  readonly datum: Vector3
  /** Distance up to which flat ground has large triangles. */
  readonly flatUntil: number
  /** Depth of skirts [cells]; 0 for none. */
  readonly skirt: number
  readonly resolution: number
  readonly detail: number
  /** Distances at which levels end. */
  readonly ranges: readonly number[]
  /** Error of a vertex, as float32 leaves it, over its distance [–]. */
  readonly rounding: number
  readonly random: () => number
  /** Height in a page whose vertices are so far apart. */
  readonly heightAt: (place: Vector3, spacing: number) => number
}

const place = new Vector3()
const [ab, ac, p, q] = Array.from({ length: 4 }, () => new Vector3())

const clamp = (value: number): number => Math.min(Math.max(value, 0), 1)
const lerp = (from: number, to: number, part: number): number => from + (to - from) * part
function smoothstep([start, end]: readonly [number, number], value: number): number {
  const t = clamp((value - start) / (end - start))
  return t * t * (3 - 2 * t)
}

/**
 * A tile as it is drawn: float64 twin of `tileVertex`, positions by plain differences of places.
 */
export class DrawnTile {
  readonly #first: Vector3
  readonly #second: Vector3
  readonly #cell: number
  readonly #vertices = new Map<number, Vector3>()

  constructor(
    readonly tile: Tile,
    readonly drawing: Drawing
  ) {
    const { first, second } = faceAxes(tile.face)
    this.#first = first.multiplyScalar(tile.extent)
    this.#second = second.multiplyScalar(tile.extent)
    const { ellipsoid, resolution } = drawing
    this.#cell = (2 * tile.extent * ellipsoid.maximumRadius) / resolution
  }

  /** Length of a cell's edge [m]. */
  get cell(): number {
    return this.#cell
  }

  /** Point of the cube. */
  #cube(column: number, row: number, target: Vector3): Vector3 {
    const cells = this.drawing.resolution / 2
    return target
      .copy(this.tile.cube)
      .addScaledVector(this.#first, column / cells - 1)
      .addScaledVector(this.#second, row / cells - 1)
  }

  #height(column: number, row: number, spacing = this.#cell): number {
    const { ellipsoid, heightAt } = this.drawing
    const at = cubeToEllipsoid(this.#cube(column, row, place), ellipsoid.radii, place)
    return heightAt(at, spacing)
  }

  /** Columns and rows of a point of the cube from the tile's first corner, where the plane of its face is met. */
  cellsOf(cube: Vector3): [number, number] {
    const { tile, drawing } = this
    const { outward, first, second } = faceAxes(tile.face)
    const scale = 1 / cube.dot(outward)
    const cells = (axis: Vector3, middle: number): number =>
      (((cube.dot(axis) * scale - middle) / tile.extent + 1) * drawing.resolution) / 2
    return [cells(first, tile.x), cells(second, tile.y)]
  }

  /**
   * Viewer to a vertex, ECEF axes [m].
   *
   * @param skirt - 1 for the vertex of the skirt under one of the edge, 0 for others.
   */
  vertex(column: number, row: number, skirt: 0 | 1): Vector3 {
    const key = 2 * (column + 256 * row) + skirt
    const known = this.#vertices.get(key)
    if (known !== undefined) return known
    const made = this.#vertexOf(column, row, skirt)
    this.#vertices.set(key, made)
    return made
  }

  #vertexOf(column: number, row: number, skirt: 0 | 1): Vector3 {
    const { ellipsoid, eye, datum, flatUntil, resolution, detail, ranges, rounding, random } =
      this.drawing
    const cell = this.#cell
    const position = new Vector3()
    const [oddColumn, oddRow] = [column % 2, row % 2]
    this.#cube(column - oddColumn, row - oddRow, position)
    const distance = cubeToEllipsoid(position, ellipsoid.radii, position).distanceTo(datum)
    const start = morphStart(detail)
    const morph = clamp((distance / ranges[this.tile.level] - start) / (1 - start))
    const isOdd = oddColumn + oddRow > 0
    let moved = morph
    let height = 0
    if (isOdd) {
      const even = this.#height(column - oddColumn, row - oddRow)
      const fine = this.#height(column, row)
      const after = this.#height(column + oddColumn, row + oddRow)
      const sagitta = ((oddColumn + oddRow) * cell ** 2) / (2 * ellipsoid.radii.x)
      const bend = Math.abs(fine - (even + after) / 2 + sagitta)
      const near = 1 - smoothstep([flatUntil, 2 * flatUntil], distance)
      const flatness = (1 - smoothstep(FLAT, bend / distance)) * near
      moved = Math.max(morph, flatness)
      height = lerp(fine, even, flatness)
    } else height = morph < 1 ? this.#height(column, row) : 0
    if (morph > 0) {
      height = lerp(height, this.#height(column - oddColumn, row - oddRow, 2 * cell), morph)
    }
    const edge = (at: number): number => Number(at === resolution) - Number(at === 0)
    const cube = this.#cube(
      column - moved * oddColumn + skirt * SKIRT_WIDTH * edge(column),
      row - moved * oddRow + skirt * SKIRT_WIDTH * edge(row),
      place
    )
    cubeToEllipsoid(cube, ellipsoid.radii, position)
    const depth = skirt * Math.min(cell * this.drawing.skirt, Math.max(cell, DEEPEST_SKIRT))
    position.addScaledVector(ellipsoid.surfaceNormal(position), height - depth).sub(eye)
    const error = rounding * position.length()
    for (const axis of ['x', 'y', 'z'] as const) position[axis] += error * (2 * random() - 1)
    return position
  }

  /** True if a ray of length 1 from the viewer passes so near that it may meet the tile or its skirt. */
  isNear(ray: Vector3): boolean {
    const { center, radius, highest } = this.tile
    p.subVectors(center, this.drawing.eye)
    const along = p.dot(ray)
    const reach = 1.2 * radius + highest + this.drawing.skirt * this.#cell
    return p.addScaledVector(ray, -along).length() < reach && along > -reach
  }

  /**
   * Distance along a ray from the viewer to the front of the tile or of its skirt, in lengths of the ray; Infinity if it meets neither.
   *
   * @param column - Middle of the cells that count, like `row`.
   * @param reach - Number of cells about it that count, all by default.
   */
  distanceTo(ray: Vector3, column = 0, row = 0, reach = this.drawing.resolution): number {
    const last = this.drawing.resolution
    const [left, top] = [column, row].map(at => Math.max(Math.floor(at - reach), 0))
    const [right, bottom] = [column, row].map(at => Math.min(Math.ceil(at + reach), last))
    let nearest = Infinity
    const meet = (a: Vector3, b: Vector3, c: Vector3): void => {
      nearest = Math.min(nearest, distanceToTriangle(ray, a, b, c))
    }
    for (let j = top; j < bottom; j++) {
      for (let i = left; i < right; i++) {
        const [a, d] = [this.vertex(i, j, 0), this.vertex(i + 1, j + 1, 0)]
        meet(a, this.vertex(i + 1, j, 0), d)
        meet(a, d, this.vertex(i, j + 1, 0))
      }
    }
    const meetSkirt = (i: number, j: number, k: number, l: number): void => {
      const [a, d] = [this.vertex(i, j, 0), this.vertex(k, l, 1)]
      meet(a, this.vertex(i, j, 1), d)
      meet(a, d, this.vertex(k, l, 0))
    }
    if (this.drawing.skirt === 0) return nearest
    for (let i = left; i < right; i++) {
      if (top === 0) meetSkirt(i, 0, i + 1, 0)
      if (bottom === last) meetSkirt(i + 1, last, i, last)
    }
    for (let j = top; j < bottom; j++) {
      if (right === last) meetSkirt(last, j, last, j + 1)
      if (left === 0) meetSkirt(0, j + 1, 0, j)
    }
    return nearest
  }
}

/** Distance along a ray from the origin to the front of a triangle, which has its edges (Möller and Trumbore 1997). */
function distanceToTriangle(ray: Vector3, a: Vector3, b: Vector3, c: Vector3): number {
  ab.subVectors(b, a)
  ac.subVectors(c, a)
  const size = ab.dot(p.crossVectors(ray, ac))
  if (size <= 0) return Infinity
  const u = -a.dot(p) / size
  if (u < -EDGE || u > 1 + EDGE) return Infinity
  q.crossVectors(ab, a)
  const v = ray.dot(q) / size
  const distance = ac.dot(q) / size
  return v >= -EDGE && u + v <= 1 + EDGE && distance > 0 ? distance : Infinity
}

/** Rounding of float64 at a triangle's edge, over the triangle. */
const EDGE = 1e-9
