import { Vector3 } from 'three'
import { HeightReadback } from '../pages/HeightReadback'
import type { PageAtlas } from '../pages/PageAtlas'
import type { TileSelection } from './TileTree'
import type { Tile } from './Tile'
import { faceAxes } from './cpu/cubeSphere'
import { cubeToFigure, type Figure } from './cpu/figure'
import type { Viewer } from './cpu/viewer'

/** Parts of the circle about the viewer, each with its own horizon: about a third of a degree; a power of two. */
const BINS = 1024
const BIN = 4 / BINS

/** Level from which on tiles hide others: larger ones are bent, and few. */
const COARSEST = 6

/** Azimuth that a line on the ground spans, from which on it is too near to hide anything [quarters of a turn]. */
const LONGEST = 0.5

/** Slope by which lines of sight to hidden ground must pass below the horizon: a fifth of a pixel at 1080 lines [–]. */
const MARGIN = 2e-4

/** Distance from which on tiles hide others and are hidden, in heights of the viewer above the ground. Less: hardly more is hidden, for twice the time. */
const NEAREST = 30

/** Height of the viewer above the ground up to which hidden tiles are looked for [m]. */
const HIGHEST = 2e4

/** Selections without a search after one in which nothing was hidden: a viewer high up sees all. */
const REST = 15

/** While pages are missing, ground near the viewer is drawn under a ceiling: steepest lines of sight that it leaves alone [–], from so many heights of the viewer on. */
const UNDER_CEILING = { slope: 0.5, from: 4 }

/** Ground of a tile as it may be drawn. ECEF axes [m]. */
interface Relief {
  readonly own: Float32Array
  readonly parent: Float32Array
  readonly seaLevel: number
  /** Lines along its middle row and column, on the ground, or below it: x, y and z of both ends of each. */
  readonly lines: Float64Array
  /** Corners, as high as the highest of its ground. */
  readonly corners: Float64Array
}

/** A tile as the viewer sees it. */
interface Seen {
  readonly tile: Tile
  readonly relief: Relief
  /** Horizontal distances that its ground lies between [m]. */
  readonly near: number
  readonly far: number
}

const place = new Vector3()
const normal = new Vector3()
const up = new Vector3()
const east = new Vector3()
const north = new Vector3()

/** Azimuth without trigonometry, in [0, 4): as it grows, so does this. */
function quarterTurns(x: number, y: number): number {
  const part = y / (Math.abs(x) + Math.abs(y) || 1)
  if (x < 0) return 2 - part
  return part < 0 ? 4 + part : part
}

/** Difference of two azimuths, in [−2, 2). */
function turn(from: number, to: number): number {
  const difference = to - from
  if (difference >= 2) return difference - 4
  return difference < -2 ? difference + 4 : difference
}

/**
 * Takes tiles out of view.
 *
 * @param isKept - True if they go behind those in view, for they may cast shadows into it.
 */
function leaveOut(selection: TileSelection, hidden: ReadonlySet<Tile>, isKept: boolean): void {
  const { tiles, inView } = selection
  const unseen = tiles.splice(inView)
  let count = 0
  for (const tile of tiles) if (!hidden.has(tile)) tiles[count++] = tile
  tiles.length = selection.inView = count
  if (isKept) tiles.push(...hidden)
  tiles.push(...unseen)
}

/**
 * Horizon culling: a terrain does not draw tiles that other ground hides from the viewer.
 *
 * ```ts
 * const terrain = new Terrain(atmosphere, heights, { horizon: new TerrainHorizon() })
 * ```
 *
 * Tiles are visited from near to far. Lines across those that lie wholly before a tile are on the ground as it is drawn, or below it, whatever
 * share of its parent's page it is drawn with: what is seen under them is hidden. Their heights come back from the GPU.
 */
export class TerrainHorizon {
  /** Slope of the line of sight to the horizon, by azimuth [–]. */
  readonly #slopes = new Float64Array(BINS)
  readonly #reliefs = new WeakMap<Tile, Relief>()
  /** Selections left without a search. */
  #rest = 0

  #figure!: Figure
  #resolution = 0

  /** Read-back of the heights of a terrain's pages to the CPU. */
  readback(atlas: PageAtlas, rows: number): HeightReadback {
    return new HeightReadback(atlas, rows)
  }

  /**
   * Takes tiles out of view that others hide: behind the others if there are shadows, into which they may cast theirs.
   *
   * @param resolution - Cells along a tile's edge.
   */
  cull(selection: TileSelection, viewer: Viewer, figure: Figure, resolution: number): void {
    if (viewer.clearance > HIGHEST || --this.#rest > 0) return
    this.#figure = figure
    this.#resolution = resolution
    this.#slopes.fill(-Infinity)
    this.#figure.surfaceNormal(viewer.position, up)
    east.set(-up.y, up.x, 0)
    if (east.lengthSq() < 1e-6) east.set(1, 0, 0)
    east.normalize()
    north.crossVectors(up, east)
    const known: Seen[] = []
    for (let i = 0; i < selection.inView; i++) {
      const seen = this.#seen(selection.tiles[i], viewer)
      if (seen !== null) known.push(seen)
    }
    const before = known.toSorted((a, b) => a.far - b.far)
    const hidden = new Set<Tile>()
    const isFine = selection.lag === 0
    const most = isFine ? Infinity : UNDER_CEILING.slope
    let next = 0
    // Tiles in view are sorted by distance, and so by `near`.
    for (const seen of known) {
      for (; next < before.length && before[next].far <= seen.near; next++) {
        const { tile, relief, near } = before[next]
        // What is under the horizon does not raise it.
        const isSure = isFine || near > Math.max(UNDER_CEILING.from * viewer.clearance, tile.radius)
        if (isSure && !hidden.has(tile)) this.#raise(relief, viewer, most)
      }
      if (this.#isHidden(seen, viewer)) hidden.add(seen.tile)
    }
    if (hidden.size === 0) this.#rest = REST
    else leaveOut(selection, hidden, viewer.shadowDistance > 0)
  }

  #seen(tile: Tile, { position, clearance, seaLevel }: Viewer): Seen | null {
    const { heights, parent, level, distance, center, radius } = tile
    if (distance < NEAREST * clearance) return null
    if (level < COARSEST || heights === null || !parent?.heights) return null
    let relief = this.#reliefs.get(tile)
    const isNew =
      relief?.own !== heights || relief.parent !== parent.heights || relief.seaLevel !== seaLevel
    if (relief === undefined || isNew) {
      relief = this.#reliefOf(tile, heights, parent.heights, seaLevel)
      this.#reliefs.set(tile, relief)
    }
    place.copy(center).sub(position)
    const [x, y] = [place.dot(east), place.dot(north)]
    // Heights lean outwards, and the globe bends, by far less than these.
    const far = Math.sqrt(x * x + y * y) + 1.05 * radius
    const below = clearance + (distance * distance) / (2 * this.#figure.minimumRadius)
    const near = 0.99 * Math.sqrt(Math.max(distance * distance - below * below, 0))
    return { tile, relief, near, far }
  }

  #reliefOf(tile: Tile, own: Float32Array, parent: Float32Array, seaLevel: number): Relief {
    const resolution = this.#resolution
    const side = resolution + 1
    const { first, second } = faceAxes(tile.face)
    /** Writes a point of the tile at a height. */
    const put = (target: Float64Array, n: number, x: number, y: number, height: number): void => {
      place.copy(tile.cube)
      place.addScaledVector(first, ((2 * x) / resolution - 1) * tile.extent)
      place.addScaledVector(second, ((2 * y) / resolution - 1) * tile.extent)
      cubeToFigure(place, this.#figure, place)
      place.addScaledVector(this.#figure.surfaceNormal(place, normal), height).toArray(target, n)
    }
    const [left, top] = [tile.quarter % 2, tile.quarter >> 1].map(half => (half * resolution) / 2)
    const ownAt = (column: number, row: number): number => own[row * side + column]
    const parentAt = (column: number, row: number): number =>
      parent[(top + row / 2) * side + left + column / 2]
    let highest = seaLevel
    for (let row = 0; row <= resolution; row++) {
      for (let column = 0; column <= resolution; column++) {
        const isEven = row % 2 === 0 && column % 2 === 0
        const other = isEven ? parentAt(column, row) : seaLevel
        highest = Math.max(highest, ownAt(column, row), other)
      }
    }
    const middle = 2 * Math.floor(resolution / 4)
    const lines = new Float64Array(6 * resolution)
    let n = 0
    const addLine = (x: number, y: number, dx: number, dy: number): void => {
      const [endX, endY] = [x + 2 * dx, y + 2 * dy]
      const before = Math.min(ownAt(x, y), parentAt(x, y), ownAt(x + dx, y + dy))
      const height = Math.max(Math.min(before, ownAt(endX, endY), parentAt(endX, endY)), seaLevel)
      put(lines, n, x, y, height)
      put(lines, n + 3, endX, endY, height)
      n += 6
    }
    for (let i = 0; i < resolution; i += 2) {
      addLine(i, middle, 1, 0)
      addLine(middle, i, 0, 1)
    }
    const corners = new Float64Array(12)
    for (let i = 0; i < 4; i++) {
      put(corners, 3 * i, (i % 2) * resolution, (i >> 1) * resolution, highest)
    }
    return { own, parent, seaLevel, lines, corners }
  }

  /** Raises the horizon to a tile's ground. Thousands of lines in a frame: in plain numbers. */
  #raise({ lines }: Relief, { position }: Viewer, most: number): void {
    const slopes = this.#slopes
    const { x: eastX, y: eastY } = east
    const { x: northX, y: northY, z: northZ } = north
    const { x: upX, y: upY, z: upZ } = up
    let start = 0
    let lowest = 0
    for (let n = 0; n < lines.length; n += 3) {
      const x = lines[n] - position.x
      const y = lines[n + 1] - position.y
      const z = lines[n + 2] - position.z
      const across = eastX * x + eastY * y + east.z * z
      const along = northX * x + northY * y + northZ * z
      const slope = (upX * x + upY * y + upZ * z) / Math.sqrt(across * across + along * along)
      const azimuth = quarterTurns(across, along)
      if (n % 6 === 0) {
        start = azimuth
        lowest = slope
        continue
      }
      const length = turn(start, azimuth)
      if (Math.abs(length) > LONGEST) continue
      lowest = Math.min(lowest, slope, most)
      // A line below the eye is farther down in its middle than at its ends.
      lowest -= 0.35 * length * length * Math.abs(lowest)
      const from = Math.min(start, start + length) / BIN
      const to = Math.max(start, start + length) / BIN
      for (let bin = Math.ceil(from); bin + 1 <= to; bin++) {
        const i = bin & (BINS - 1)
        if (slopes[i] < lowest) slopes[i] = lowest
      }
    }
  }

  #isHidden({ tile, relief, near, far }: Seen, { position }: Viewer): boolean {
    if (near <= 0) return false
    place.copy(tile.center).sub(position)
    const middle = quarterTurns(place.dot(east), place.dot(north))
    let [first, last, highest] = [0, 0, -Infinity]
    for (let n = 0; n < 12; n += 3) {
      place.fromArray(relief.corners, n).sub(position)
      const aside = turn(middle, quarterTurns(place.dot(east), place.dot(north)))
      first = Math.min(first, aside)
      last = Math.max(last, aside)
      highest = Math.max(highest, place.dot(up))
    }
    if (last - first > 2 * LONGEST) return false
    // The ground rises over its corners by its sagitta.
    highest += tile.radius ** 2 / this.#figure.minimumRadius
    const slope = highest / (highest > 0 ? near : far) + MARGIN
    const end = Math.ceil((middle + last) / BIN) + 1
    for (let bin = Math.floor((middle + first) / BIN) - 1; bin < end; bin++) {
      if (!(this.#slopes[bin & (BINS - 1)] > slope)) return false
    }
    return true
  }
}
