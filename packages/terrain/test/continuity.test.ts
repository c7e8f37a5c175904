import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { cubeToEllipsoid, faceAxes } from '../src/tiles/cpu/cubeSphere'
import { viewerOf, type Viewer } from '../src/tiles/cpu/viewer'
import type { Tile } from '../src/tiles/Tile'
import { noTiles, TileTree } from '../src/tiles/TileTree'
import { morphStart } from '../src/tiles/tsl/tileVertex'

const earth = Ellipsoid.WGS84
const source = new MountainHeights({ seed: 513 })
const DETAIL = 1.2
/** Bounds alone: which tiles are split does not depend on heights. */
const bounds = {
  lowest: source.lowest,
  highest: source.highest,
  variation: () => 1e4,
  sampleAt: () => ({ height: 0, gradient: new Vector3() }),
  loadHeights: () => new Float32Array(0)
}
const tree = new TileTree(earth, bounds, 20, DETAIL)

/** Place [°] and height above the ground [m]. */
interface Place {
  readonly longitude: number
  readonly latitude: number
  readonly clearance: number
}

const SHORE = { longitude: 1.6848, latitude: 46.15, clearance: 2 }
const SUMMIT = { longitude: 0.438, latitude: 47.41, clearance: 2 }

/** Viewer who sees all round. */
function viewerAt({ longitude, latitude, clearance }: Place): Viewer {
  const subpoint = earth.geodeticToECEF({ longitude, latitude, height: 0 })
  const ground = source.sampleAt(subpoint, { height: 0, gradient: new Vector3() }).height
  const position = earth.geodeticToECEF({
    longitude,
    latitude,
    height: Math.max(ground, 0) + clearance
  })
  const camera = new PerspectiveCamera(50, 1.6, 1, 1e8)
  camera.position.copy(position)
  camera.updateMatrixWorld()
  const viewer = viewerOf(camera, position, clearance, source.lowest, new Matrix4(), earth, 0, 0)
  return { ...viewer, planes: [], horizon: Math.PI }
}

const keyOf = ({ face, x, y, level }: Tile): string => `${face} ${level} ${x} ${y}`

function tilesFrom(viewer: Viewer): Map<string, Tile> {
  const { tiles } = tree.select(viewer, 1e5, noTiles(), false)
  return new Map(tiles.map(tile => [keyOf(tile), tile]))
}

/** Least distance of points of a tile on the ellipsoid [m]. */
function nearest({ face, x, y, extent }: Tile, { datumPoint }: Viewer): number {
  const { outward, first, second } = faceAxes(face)
  let least = Infinity
  for (let i = -1; i <= 1; i += 0.25) {
    for (let j = -1; j <= 1; j += 0.25) {
      const cube = outward.clone().addScaledVector(first, x + i * extent)
      cube.addScaledVector(second, y + j * extent)
      least = Math.min(least, cubeToEllipsoid(cube, earth.radii, cube).distanceTo(datumPoint))
    }
  }
  return least
}

/**
 * Tiles that a step splits or joins. Their quarters must have the shape of the whole: wholly morphed but for what the step itself is.
 *
 * @returns Their number, and the largest part of a morph that is missing beyond that.
 */
function changes(from: Place, to: Place): { count: number; excess: number } {
  const [before, after] = [viewerAt(from), viewerAt(to)]
  const step = before.datumPoint.distanceTo(after.datumPoint)
  const [old, now] = [tilesFrom(before), tilesFrom(after)]
  let count = 0
  let excess = 0
  const check = (tiles: Map<string, Tile>, others: Map<string, Tile>, viewer: Viewer): void => {
    for (const [key, tile] of tiles) {
      if (others.has(key) || tile.parent === null || !others.has(keyOf(tile.parent))) continue
      const range = tree.ranges[tile.level]
      const missing = (1 - nearest(tile, viewer) / range) / (1 - morphStart(DETAIL))
      count++
      excess = Math.max(excess, missing - step / range / (1 - morphStart(DETAIL)))
    }
  }
  check(now, old, after)
  check(old, now, before)
  return { count, excess }
}

const between = (part: number): Place => ({
  longitude: SHORE.longitude + part * (SUMMIT.longitude - SHORE.longitude),
  latitude: SHORE.latitude + part * (SUMMIT.latitude - SHORE.latitude),
  clearance: 2
})

it('no tile jumps on the way from a shore to a summit on foot', () => {
  let count = 0
  for (let stop = 0; stop < 20; stop++) {
    // A stride up to what a fast flight goes in a frame: 0.1 m to 10 m.
    const step = 10 ** (-6 + stop / 10) / 1.5
    const found = changes(between(stop / 20), between(stop / 20 + step))
    count += found.count
    expect(found.excess).toBeLessThan(1e-6)
  }
  expect(count).toBeGreaterThan(200)
})

it('no tile jumps on the way from 2 m to 20,000 km', () => {
  let count = 0
  for (let clearance = 2; clearance < 2e7; clearance *= 1.6) {
    const found = changes({ ...SUMMIT, clearance }, { ...SUMMIT, clearance: clearance * 1.01 })
    count += found.count
    expect(found.excess).toBeLessThan(1e-6)
  }
  expect(count).toBeGreaterThan(20)
})
