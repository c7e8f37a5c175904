import type { Vector3 } from 'three'
import type { GroundBounds } from '../heights/HeightSource'

/** Heights that a page asks for: a square grid over a tile, and one step beyond each of its edges. */
export interface PageRequest {
  /** Face of the cube about the planet, 0 to 5: +X, −X, +Y, −Y, +Z, −Z of ECEF. */
  readonly face: number
  /** 0 for a whole face; each next level has half the size. */
  readonly level: number
  /** Centre of the tile along the face's first axis, in (−1, 1). */
  readonly x: number
  /** Centre along the second axis. */
  readonly y: number
  /** Number of heights along an edge. */
  readonly side: number
  /** Distance between neighbours, at most [m]. */
  readonly spacing: number
  /** Number of vertices along an edge of the tile. */
  readonly vertices: number

  /**
   * Place of a height on the ellipsoid.
   *
   * @param column - 0 to `side` − 1, as `row`.
   * @returns ECEF [m].
   */
  readonly placeOf: (column: number, row: number, target: Vector3) => Vector3
}

/**
 * Heights of a planet's ground as numbers, tile by tile, that may take time to arrive: measured ones, for instance.
 * Until a tile's heights are there, and where they fail, the ground is drawn with those of the tile that it is a quarter of.
 */
export interface PageSource extends GroundBounds {
  /** As of `HeightSource`. */
  readonly seed?: number

  /**
   * Heights of a page [m], row by row, `side`² of them. Neighbouring tiles must get the same heights along their common edge. After them may
   * come `vertices`² shares of the sky, in (0, 1], that the ground about a vertex leaves free, over what its own slope leaves [–].
   *
   * @param signal - Aborted when nobody needs the page any more.
   * @returns The heights, or a promise of them. If it is rejected, or a height is not finite, they are asked for again later; anything
   * else has the terrain's next update throw.
   */
  loadHeights(request: PageRequest, signal: AbortSignal): Float32Array | Promise<Float32Array>
}

/** True of a source whose heights come as numbers. */
export const isPageSource = (source: GroundBounds): source is PageSource => 'loadHeights' in source
