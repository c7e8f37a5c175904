import { Vector3 } from 'three'
import type { GroundBounds, HeightSample } from '../heights/HeightSource'
import { sampleGround } from '../heights/sampleGround'
import { isPageSource } from '../pages/PageSource'
import { faceAxes } from './cpu/cubeSphere'
import { cubeToFigure, isFlat, type Figure } from './cpu/figure'

const sample: HeightSample = { height: 0, gradient: new Vector3() }
const corner = new Vector3()

/** A tile of the quadtree on a face of the cube about the planet. */
export class Tile {
  /** Half width on the cube of half width 1: a power of two. */
  readonly extent: number
  /** Point of the cube of half width 1 above the tile's centre. */
  readonly cube: Vector3
  /** Centre on the ellipsoid, ECEF [m]. */
  readonly center: Vector3
  /** Geodetic up at the centre. */
  readonly normal: Vector3
  /** Distance of the farthest corner from the centre, on the ellipsoid [m]. */
  readonly radius: number
  /** Unit normals, outward, of the planes through the planet's centre and the four edges; none in a flat world. */
  readonly edges: readonly Vector3[]
  /** Unit vector to the centre where the ellipsoid is the unit sphere. */
  readonly direction: Vector3
  /** Angle at the planet's centre between the tile's centre and its farthest corner, in the same space [rad]. */
  readonly spread: number
  /** Bounds of its heights, once they are loaded those of its page [m]. */
  lowest: number
  highest: number
  /** Four tiles of half its size; null before any is needed. */
  children: Tile[] | null = null
  /** Number of the last selection that visited it. */
  lastUse = 0
  /** Number of the last selection that it could be seen in. */
  lastDrawn = 0
  /** Distance from the viewer then, see `distanceTo` [m]. */
  distance = 0
  /** Approximate angular size [rad], twice that in view: the order in which missing pages are drawn. */
  urgency = 0
  /** Slot of its page in the atlas; −1 without one. */
  slot = -1
  /** Heights of its vertices as drawn, rows first, once they have come back from the GPU; null before [m]. */
  heights: Float32Array | null = null
  /** Pages that it has had so far. */
  page = 0
  /** Share of the parent's page in what is drawn, in [0, 1]: 1 as its own page arrives, then ever less. */
  fade = 1
  /** Frame in which that share last changed. */
  #frame = -1

  /**
   * @param face - Face of the cube, 0 to 5.
   * @param level - 0 for a whole face.
   * @param x - Centre along the face's first axis, in (−1, 1), like `y` along the second.
   * @param parent - Tile that it is a quarter of; null for a whole face.
   */
  constructor(
    readonly face: number,
    readonly level: number,
    readonly x: number,
    readonly y: number,
    figure: Figure,
    source: GroundBounds,
    readonly parent: Tile | null = null
  ) {
    const extent = 2 ** -level
    this.extent = extent
    const { outward, first, second } = faceAxes(face)
    this.cube = outward.clone().addScaledVector(first, x).addScaledVector(second, y)
    this.center = cubeToFigure(this.cube, figure, new Vector3())
    this.normal = figure.surfaceNormal(this.center)
    let square = 0
    for (const [i, j] of CORNERS) {
      corner
        .copy(this.cube)
        .addScaledVector(first, i * extent)
        .addScaledVector(second, j * extent)
      cubeToFigure(corner, figure, corner)
      square = Math.max(square, corner.distanceToSquared(this.center))
    }
    this.radius = Math.sqrt(square)
    const { radii } = figure
    const { x: cubeX, y: cubeY } = this
    const edge = (axis: Vector3, place: number, sign: number): Vector3 =>
      axis.clone().addScaledVector(outward, -place).divide(radii).normalize().multiplyScalar(sign)
    this.edges = (isFlat(figure) ? [] : [-1, 1]).flatMap(sign => [
      edge(first, cubeX + sign * extent, sign),
      edge(second, cubeY + sign * extent, sign)
    ])
    this.direction = this.cube.clone().normalize()
    this.spread = 2 * Math.asin(Math.min(this.radius / figure.minimumRadius / 2, 1))
    const { lowest, highest } = parent ?? source
    this.lowest = lowest
    this.highest = highest
    // Until all data has come, a source of loaded heights may answer with coarse ones.
    if (isPageSource(source)) return
    const { height } = sampleGround(source, this.center, sample)
    // Of the arc, which is longer than the chord by 11 % at most.
    const variation = source.variation(1.12 * this.radius)
    this.lowest = Math.max(lowest, height - variation)
    this.highest = Math.min(highest, height + variation)
  }

  /** Fades its page, if there is one, further in over the parent's; once in a frame unless at once. */
  show(frame: number, step: number): void {
    if (this.slot < 0 || (step < 1 && frame === this.#frame)) return
    this.#frame = frame
    this.fade = Math.max(this.fade - step, 0)
  }

  /** Number of the quarter of its parent that it is, columns first; 0 for a whole face. */
  get quarter(): number {
    const { parent } = this
    return parent === null ? 0 : Number(this.x > parent.x) + 2 * Number(this.y > parent.y)
  }

  /** Quarters, made at the first call. */
  split(figure: Figure, source: GroundBounds): Tile[] {
    const half = this.extent / 2
    return (this.children ??= CORNERS.map(
      ([i, j]) =>
        new Tile(
          this.face,
          this.level + 1,
          this.x + i * half,
          this.y + j * half,
          figure,
          source,
          this
        )
    ))
  }
}

/** Directions from the middle of a tile to its corners, by column and row. */
export const CORNERS = [
  [-1, -1],
  [1, -1],
  [-1, 1],
  [1, 1]
] as const
