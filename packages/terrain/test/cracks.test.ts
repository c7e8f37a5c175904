import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { viewerOf } from '../src/tiles/cpu/viewer'
import { faceAxes } from '../src/tiles/cpu/cubeSphere'
import { CORNERS, type Tile } from '../src/tiles/Tile'
import { noTiles, TileTree } from '../src/tiles/TileTree'
import { DrawnTile, type Drawing } from './DrawnTile'
import { randomNumbers } from './randomNumbers'

const earth = Ellipsoid.WGS84
const RESOLUTION = 8
const DETAIL = 1.2
const FINEST = 21

/** Cameras, of which so many in a row are about one place, and tiles that each looks for one with an edge in view. */
const CAMERAS = 4000
const ABOUT = 50
const TRIES = 12

/** Octaves of the ground: wavelengths from 2^6 m to 2^18 m. */
const OCTAVES = Array.from({ length: 13 }, (_, i) => {
  const wavelength = 2 ** (i + 6)
  const turn = new Vector3(Math.sin(i), Math.cos(2 * i), Math.sin(3 * i + 1)).normalize()
  return {
    wavelength,
    amplitude: Math.min(0.05 * wavelength, 250),
    wave: turn.multiplyScalar((2 * Math.PI) / wavelength)
  }
})
const HIGHEST = OCTAVES.reduce((sum, { amplitude }) => sum + amplitude, 0)

/** Hills, of which a page with vertices so far apart has those that are long enough, as pages on the GPU have. */
function heightAt(place: Vector3, spacing: number): number {
  let height = 0
  for (const { wavelength, amplitude, wave } of OCTAVES) {
    const share = Math.min(Math.max(wavelength / (2 * spacing) - 1, 0), 1)
    if (share > 0) height += share * amplitude * Math.sin(wave.dot(place))
  }
  return height
}

/** Bounds alone: loaded heights, whose tiles ask for none. */
const bounds = {
  lowest: -HIGHEST,
  highest: HIGHEST,
  variation: () => 2 * HIGHEST,
  sampleAt: () => ({ height: 0, gradient: new Vector3() }),
  loadHeights: () => new Float32Array(0)
}

/** Tiles of a selection about points of the cube. */
class Ground {
  readonly #drawn = new Map<Tile, DrawnTile | null>()

  constructor(
    readonly tree: TileTree,
    readonly tiles: readonly Tile[],
    readonly drawing: Drawing
  ) {
    for (const tile of tiles) this.#drawn.set(tile, null)
  }

  drawn(tile: Tile): DrawnTile {
    const known = this.#drawn.get(tile)
    if (known) return known
    const made = new DrawnTile(tile, this.drawing)
    this.#drawn.set(tile, made)
    return made
  }

  /** The tile at a point of the cube; undefined if it was left out. */
  tileAt(cube: Vector3): Tile | undefined {
    const face = faceOf(cube)
    const { first, second } = faceAxes(face)
    const scale = 1 / Math.abs(cube.getComponent(face >> 1))
    const [x, y] = [cube.dot(first) * scale, cube.dot(second) * scale]
    let tile: Tile | undefined = this.tree.roots[face]
    while (tile !== undefined && !this.#drawn.has(tile)) {
      tile = tile.children?.[Number(x > tile.x) + 2 * Number(y > tile.y)]
    }
    return tile
  }

  /** True if a line of sight ends on the front of ground within 1.5 cells of a point of the cube, in tiles that have points so far from it. */
  isSeenAt(ray: Vector3, cube: Vector3, size: number): boolean {
    const tried = new Set<Tile>()
    const { first, second } = faceAxes(faceOf(cube))
    for (const [i, j] of CORNERS) {
      near
        .copy(cube)
        .addScaledVector(first, i * size)
        .addScaledVector(second, j * size)
      const tile = this.tileAt(near)
      if (tile === undefined || tried.has(tile)) continue
      tried.add(tile)
      const drawn = this.drawn(tile)
      const [column, row] = drawn.cellsOf(cube)
      if (drawn.distanceTo(ray, column, row, 1.5) < Infinity) return true
    }
    return false
  }

  /** True if a line of sight of length 1 ends on the front of any ground. */
  isSeen(ray: Vector3): boolean {
    return this.tiles.some(tile => {
      const drawn = this.drawn(tile)
      return drawn.isNear(ray) && drawn.distanceTo(ray) < Infinity
    })
  }
}

const near = new Vector3()

function faceOf({ x, y, z }: Vector3): number {
  const sizes = [x, y, z].map(Math.abs)
  const axis = sizes.indexOf(Math.max(...sizes))
  return 2 * axis + Number([x, y, z][axis] < 0)
}

const NONE = new Matrix4()

/**
 * Looks for lines of sight to the ground that end on none, from cameras anywhere: all go to the edge of a tile, up to a tenth of a cell or down to
 * a billionth beside it.
 *
 * @param rounding - Error of a vertex over its distance: that of float32 is 1e-7.
 */
function findHoles(cameras: number, skirt = 1, rounding = 3e-7): { holes: number; rays: number } {
  const random = randomNumbers(29)
  const camera = new PerspectiveCamera(30, 16 / 9, 1, 1e9)
  const axes = new Matrix4()
  const [subpoint, ray, point, cube, edge, up] = Array.from({ length: 6 }, () => new Vector3())
  // What is sure to be below the horizon, coarse cells being chords.
  const core = earth.grown(-HIGHEST - 7e4)
  let tree = new TileTree(earth, bounds, FINEST, DETAIL)
  let [longitude, latitude, above] = [0, 0, 0]
  let [rays, holes] = [0, 0]
  /** Point of the cube under a point that is seen from the camera. */
  const underneath = (seen: Vector3): Vector3 => {
    cube.copy(seen).add(camera.position).divide(earth.radii)
    return cube.divideScalar(Math.max(...cube.toArray().map(Math.abs)))
  }
  for (let n = 0; n < cameras; n++) {
    if (n % ABOUT === 0) {
      longitude = 360 * random() - 180
      latitude = (Math.asin(2 * random() - 1) * 180) / Math.PI
      above = 2 * 1e7 ** random()
      tree = new TileTree(earth, bounds, FINEST, DETAIL)
    }
    const away = 1e-6 * Math.min(above, 1e6)
    const place = {
      longitude: longitude + away * random(),
      latitude: latitude - Math.sign(latitude) * away * random()
    }
    earth.geodeticToECEF(place, subpoint)
    const clearance = above * 1.2 ** random()
    const height = heightAt(subpoint, 1e-3) + clearance
    earth.geodeticToECEF({ ...place, height }, camera.position)
    camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(camera.position, axes))
    camera.rotateY(2 * Math.PI * random())
    camera.rotateX((-Math.PI / 2) * random())
    camera.updateMatrixWorld()
    const viewer = viewerOf(camera, camera.position, clearance, -HIGHEST, NONE, earth, 0)
    const { tiles } = tree.select(viewer, 3000, noTiles(), false)
    // Nothing but space.
    if (tiles.length === 0) continue
    const ground = new Ground(tree, tiles, {
      ellipsoid: earth,
      eye: camera.position,
      datum: viewer.datumPoint,
      flatUntil: 2000 + 100 * clearance,
      skirt,
      resolution: RESOLUTION,
      detail: DETAIL,
      ranges: tree.ranges,
      rounding,
      random,
      heightAt
    })
    for (let i = 0; i < TRIES; i++) {
      const tile = tiles[Math.floor(random() * tiles.length)]
      const drawn = ground.drawn(tile)
      const size = (2 * tile.extent) / RESOLUTION / 50
      const across = random() < 0.5 ? 0 : RESOLUTION
      const isColumn = random() < 0.5
      const vertexAt = (along: number): Vector3 =>
        isColumn ? drawn.vertex(across, along, 0) : drawn.vertex(along, across, 0)
      const along = Math.floor(RESOLUTION * random())
      // Corners as often as all else.
      edge.copy(vertexAt(along)).lerp(vertexAt(along + 1), random() < 0.5 ? 0 : random())
      if (core.intersectRayDistance(camera.position, edge) === null) continue
      earth.surfaceNormal(point.copy(edge).add(camera.position), up)
      if (up.dot(edge) >= 0) continue
      const { x, y } = point.project(camera)
      if (Math.max(Math.abs(x), Math.abs(y)) > 0.999) continue
      const slip = (largest: number): Vector3 =>
        ray
          .set(random() - 0.5, random() - 0.5, random() - 0.5)
          .multiplyScalar(largest)
          .add(edge)
      // On a slope that faces away: ground before it hides it.
      underneath(edge)
      const isInFront = (): boolean => ground.isSeenAt(slip(0.05 * drawn.cell), cube, size)
      if (![0, 1, 2, 3].some(isInFront)) continue
      rays++
      slip(drawn.cell * 10 ** (-9 + 8 * random())).normalize()
      if (!ground.isSeenAt(ray, cube, size) && !ground.isSeen(ray)) holes++
      break
    }
  }
  return { holes, rays }
}

it(`${CAMERAS} cameras anywhere see no gap between tiles, whatever rounding leaves`, () => {
  const { holes, rays } = findHoles(CAMERAS)
  expect(rays).toBeGreaterThan(CAMERAS / 2)
  expect(holes).toBe(0)
})

it('without skirts they would', () => {
  expect(findHoles(300, 0).holes).toBeGreaterThan(5)
})
