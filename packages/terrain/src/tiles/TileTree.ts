import { Vector3 } from 'three'
import type { GroundBounds } from '../heights/HeightSource'
import { facesOf, type Figure } from './cpu/figure'
import { horizonAngle, type Viewer } from './cpu/viewer'
import { Tile } from './Tile'

/** Selections without a visit after which a tile is forgotten. */
const FORGET_AFTER = 240

/** Selections between two searches for tiles to forget. */
const FORGET_EVERY = 60

/**
 * Factor on the distance at which a tile is split that is out of view and only casts shadows: two levels coarser. 1: at eye height there is no room for
 * the pages of all of them, and ground in view is left coarse (*Terrain*, `castShadow`).
 */
const UNSEEN = 0.25

/** Tiles chosen for a viewer. */
export interface TileSelection {
  /** Tiles in view first, then those out of it that may cast shadows into it. */
  readonly tiles: Tile[]
  /** Number of those in view. */
  inView: number
  /** Tiles of those whose page is missing, the most urgent first. */
  readonly missing: Tile[]
  /** Levels that the ground is coarser than it ought to be, at most. */
  lag: number
}

/** A selection of nothing. */
export const noTiles = (): TileSelection => ({ tiles: [], inView: 0, missing: [], lag: 0 })

/**
 * Quadtree of tiles on the six faces of a cube about the planet, or on one for a flat world, and the choice of those to draw.
 *
 * A tile is split where its nearest point is within the range of the next level; ranges double from a level to
 * the one above. That alone keeps neighbours within one level of each other, and the finer of two is wholly
 * morphed to the coarser one's grid where they meet.
 *
 * @see Strugar 2010, "Continuous distance-dependent level of detail for rendering heightmaps", §3.2 and §3.3
 */
export class TileTree {
  /** Finest level. */
  readonly finestLevel: number
  /** Whole faces. */
  readonly roots: readonly Tile[]
  /** Number of selections so far. */
  selections = 0
  /** Distances from the viewer at which levels end; infinity for the coarsest [m]. */
  readonly ranges: readonly number[]

  /**
   * @param finestLevel - Level of the smallest tiles.
   * @param detail - Distance at which a tile is split, in diagonals of it; > 1.
   */
  constructor(
    readonly figure: Figure,
    readonly source: GroundBounds,
    finestLevel: number,
    detail: number
  ) {
    this.finestLevel = finestLevel
    // Longest diagonal of a tile of level 0: that of the cube's face, at the face's middle.
    const diagonal = 2 * Math.SQRT2 * figure.maximumRadius
    this.ranges = Array.from({ length: finestLevel + 1 }, (_, level) =>
      level === 0 ? Infinity : (detail * diagonal) / 2 ** (level - 1)
    )
    this.roots = facesOf(figure).map(face => new Tile(face, 0, 0, 0, figure, source))
  }

  /**
   * Tiles to draw. They cover what a viewer can see, each point once.
   *
   * @param most - Number of tiles that there is room for: beyond it tiles are left unsplit.
   * @param isPaged - True if a tile is split only when its own page is there and shown.
   */
  select(viewer: Viewer, most: number, target: TileSelection, isPaged = true): TileSelection {
    this.selections++
    const unseen: Tile[] = []
    target.tiles.length = target.missing.length = 0
    target.lag = 0
    // Nearest level by level: if room runs out, what is coarse is far away.
    let open: Tile[] = [...this.roots]
    const radius = this.figure.minimumRadius
    while (open.length > 0) {
      const next: Tile[] = []
      for (let i = 0; i < open.length; i++) {
        const tile = open[i]
        tile.lastUse = this.selections
        const isVisible = isInFrustum(tile, viewer, radius)
        if (!isVisible && !mayCastShadow(tile, viewer)) continue
        if (isBelowHorizon(tile, viewer, radius)) continue
        const taken = target.tiles.length + unseen.length + next.length + (open.length - i)
        tile.lastDrawn = this.selections
        const distance = distanceTo(tile, viewer.datumPoint)
        tile.distance = distance
        const range = this.ranges[tile.level + 1] * (isVisible ? 1 : UNSEEN)
        const isNear = tile.level < this.finestLevel && distance < range
        const isShown = !isPaged || (tile.slot >= 0 && tile.fade === 0)
        if (isNear && isShown && taken + 4 <= most) {
          next.push(...tile.split(this.figure, this.source))
          continue
        }
        if (isVisible) target.tiles.push(tile)
        else unseen.push(tile)
        if (isShown) continue
        const finer = isNear ? Math.log2(range / Math.max(distance, this.ranges.at(-1)! / 2)) : 0
        target.lag = Math.max(target.lag, Math.ceil(finer) + 1)
        if (tile.slot < 0) {
          // Half of what tiles in view are, at the same size in the picture.
          const near = Math.max(distance, tile.radius / 8)
          tile.urgency = (tile.radius / near) * (isVisible ? 2 : 1)
          target.missing.push(tile)
        }
      }
      open = next
    }
    // What is near hides what is far.
    target.tiles.sort((a, b) => a.distance - b.distance)
    target.inView = target.tiles.length
    target.tiles.push(...unseen)
    target.missing.sort((a, b) => b.urgency - a.urgency)
    if (this.selections % FORGET_EVERY === 0) for (const root of this.roots) this.#forget(root)
    return target
  }

  /**
   * Forgets tiles that no selection has visited for long, and that have no page.
   *
   * @returns True if the tile itself may go.
   */
  #forget(tile: Tile): boolean {
    // All four, without stopping at the first that may not go.
    const kept = (tile.children ?? []).filter(child => !this.#forget(child))
    if (kept.length === 0) tile.children = null
    return kept.length === 0 && tile.slot < 0 && this.selections - tile.lastUse > FORGET_AFTER
  }
}

/**
 * Lower bound of the distance from a point to a tile on the ellipsoid [m]: outside of the sphere about the tile, and of the planes
 * through the planet's centre and its edges; in a flat world that to the square.
 */
export function distanceTo({ center, radius, edges }: Tile, point: Vector3): number {
  if (edges.length === 0) {
    const half = radius / Math.SQRT2
    const x = Math.max(Math.abs(point.x - center.x) - half, 0)
    const z = Math.max(Math.abs(point.z - center.z) - half, 0)
    return Math.hypot(x, point.y, z)
  }
  let distance = center.distanceTo(point) - radius
  for (const edge of edges) distance = Math.max(distance, edge.dot(point))
  return distance
}

const point = new Vector3()

/** Level from which on tiles are flat discs, but for their heights. */
const FLAT_LEVEL = 4

/**
 * True of a tile whose ground may be in view.
 *
 * @param size - Smallest radius of the planet [m].
 */
function isInFrustum(tile: Tile, viewer: Viewer, size: number): boolean {
  const { position, planes, seaLevel } = viewer
  const { normal, radius, level } = tile
  const lowest = Math.max(tile.lowest, seaLevel)
  const highest = Math.max(tile.highest, seaLevel)
  point.subVectors(tile.center, position).addScaledVector(normal, (lowest + highest) / 2)
  const across = radius * (1 + Math.max(highest, 0) / size)
  // The ground bends down by its sagitta.
  const along = (highest - lowest) / 2 + across ** 2 / size
  for (const plane of planes) {
    const outside = -plane.distanceToPoint(point)
    // Most middles are inside: no square root for them.
    if (outside <= 0) continue
    const cosine = level < FLAT_LEVEL ? 1 : Math.abs(plane.normal.dot(normal))
    const sine = level < FLAT_LEVEL ? 1 : Math.sqrt(Math.max(1 - cosine ** 2, 0))
    if (outside > across * sine + along * cosine) return false
  }
  return true
}

/** True of a tile near enough to cast shadows into view. */
const mayCastShadow = (tile: Tile, { datumPoint, shadowDistance }: Viewer): boolean =>
  shadowDistance > 0 && distanceTo(tile, datumPoint) < shadowDistance

/** True of a tile that the planet itself hides. */
function isBelowHorizon(
  { direction, spread, highest: ground }: Tile,
  viewer: Viewer,
  radius: number
): boolean {
  const cosine = viewer.direction.dot(direction)
  // Most tiles are this side of it: no arccosine for them.
  if (cosine >= viewer.cosHorizon) return false
  const highest = Math.max(ground, viewer.seaLevel)
  const angle = Math.acos(Math.max(cosine, -1)) - spread
  if (angle <= viewer.horizon) return false
  return angle > viewer.horizon + horizonAngle(1 + Math.max(highest, 0) / radius, viewer.occluder)
}
