import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { cubeToEllipsoid, faceAxes } from '../src/tiles/cpu/cubeSphere'
import { viewerOf, type Viewer } from '../src/tiles/cpu/viewer'
import { TerrainHorizon } from '../src/tiles/TerrainHorizon'
import { noTiles, TileTree, type TileSelection } from '../src/tiles/TileTree'
import type { Tile } from '../src/tiles/Tile'

const earth = Ellipsoid.WGS84
const source = new MountainHeights({ seed: 513 })
const RESOLUTION = 4
const SIDE = RESOLUTION + 1
const FINEST = 19

/** Steps of a line of sight, each longer than the one before by this factor. */
const GROWTH = 1.012

const heightOf = (position: Vector3): number =>
  Math.max(source.sampleAt(position, { height: 0, gradient: new Vector3() }).height, 0)

/** Gives a tile the heights that its page would have. */
function bake(tile: Tile): void {
  if (tile.heights !== null) return
  const { first, second } = faceAxes(tile.face)
  tile.heights = Float32Array.from({ length: SIDE ** 2 }, (_, i) => {
    const [x, y] = [i % SIDE, Math.floor(i / SIDE)].map(
      cell => ((2 * cell) / RESOLUTION - 1) * tile.extent
    )
    const point = tile.cube.clone().addScaledVector(first, x).addScaledVector(second, y)
    return heightOf(cubeToEllipsoid(point, earth.radii, point))
  })
}

/** Ground as it is drawn from a place: each tile with its own page, or wholly with its parent's. */
class Drawn {
  readonly viewer: Viewer
  readonly selection: TileSelection = noTiles()
  readonly all: readonly Tile[]
  readonly #drawn: ReadonlySet<Tile>
  readonly #tree = new TileTree(earth, source, FINEST, 1.2)

  constructor(longitude: number, latitude: number, clearance: number, heading: number) {
    const foot = earth.geodeticToECEF({ longitude, latitude, height: 0 })
    const height = heightOf(foot) + clearance
    const position = earth.geodeticToECEF({ longitude, latitude, height })
    const camera = new PerspectiveCamera(60, 16 / 9, 1, 1e8)
    camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, new Matrix4()))
    camera.rotateY(heading)
    camera.position.copy(position)
    camera.updateMatrixWorld()
    const identity = new Matrix4()
    this.viewer = viewerOf(camera, position, clearance, 0, identity, earth, 0, 0, true)
    this.#tree.select(this.viewer, 1e5, this.selection, false)
    this.all = this.selection.tiles.slice(0, this.selection.inView)
    this.#drawn = new Set(this.all)
    for (const tile of this.all) for (const each of [tile, tile.parent]) if (each) bake(each)
  }

  /** Height of the drawn ground below a point; null where nothing is drawn [m]. */
  heightBelow(position: Vector3, morph: 0 | 1): number | null {
    const cube = earth.footPoint(position).divide(earth.radii)
    const largest = Math.max(Math.abs(cube.x), Math.abs(cube.y), Math.abs(cube.z))
    cube.divideScalar(largest)
    for (const root of this.#tree.roots) {
      const { outward, first, second } = faceAxes(root.face)
      if (cube.dot(outward) < 1 - 1e-12) continue
      const [x, y] = [cube.dot(first), cube.dot(second)]
      let tile = root
      while (tile.children !== null && !this.#drawn.has(tile)) {
        const { x: middleX, y: middleY } = tile
        tile = tile.children[(x > middleX ? 1 : 0) + (y > middleY ? 2 : 0)]
      }
      return this.#drawn.has(tile) ? interpolated(tile, x, y, morph) : null
    }
    return null
  }
}

/** Height of a tile's triangles [m]. */
function interpolated(tile: Tile, x: number, y: number, morph: 0 | 1): number {
  const of = morph === 1 && tile.parent?.heights ? tile.parent : tile
  const heights = of.heights!
  const [u, v] = [x - of.x, y - of.y].map(away =>
    Math.min(Math.max(((away / of.extent + 1) / 2) * RESOLUTION, 0), RESOLUTION - 1e-9)
  )
  const [column, row] = [Math.floor(u), Math.floor(v)]
  const [a, b] = [u - column, v - row]
  const at = (i: number, j: number): number => heights[(row + j) * SIDE + column + i]
  const corner = at(0, 0)
  return a >= b
    ? corner + a * (at(1, 0) - corner) + b * (at(1, 1) - at(1, 0))
    : corner + b * (at(0, 1) - corner) + a * (at(1, 1) - at(0, 1))
}

/** Height of a point over the ellipsoid [m]. */
const altitude = (point: Vector3): number => earth.heightAt(point)

/** True if the drawn ground is between the viewer and a point. */
function isHidden(drawn: Drawn, point: Vector3, morph: 0 | 1): boolean {
  const { position } = drawn.viewer
  const ray = point.clone().sub(position)
  const length = ray.length()
  const on = new Vector3()
  for (let distance = 1; distance < length; distance *= GROWTH) {
    on.copy(position).addScaledVector(ray, distance / length)
    const height = drawn.heightBelow(on, morph)
    if (height !== null && altitude(on) < height) return true
  }
  return false
}

const PLACES = [
  [1, 47, 2, 0],
  [0.494, 46.35, 2, 0.4],
  [0.494, 46.35, 300, 2],
  [0.428, 47.372, 2, 3]
] as const

it('leaves out only tiles that nobody sees', () => {
  let hidden = 0
  let all = 0
  for (const [longitude, latitude, clearance, heading] of PLACES) {
    const drawn = new Drawn(longitude, latitude, clearance, heading)
    const { selection, viewer } = drawn
    new TerrainHorizon().cull(selection, { ...viewer, shadowDistance: 1 }, earth, RESOLUTION)
    all += drawn.all.length
    expect(new Set(selection.tiles)).toEqual(new Set(drawn.all))
    const left = selection.tiles.slice(selection.inView)
    hidden += left.length
    for (const [n, tile] of left.entries()) {
      const { first, second } = faceAxes(tile.face)
      const [x, y] = [
        tile.x + tile.extent * (((n * 7) % 5) / 2 - 1),
        tile.y + tile.extent * (((n * 3) % 5) / 2 - 1)
      ]
      for (const morph of [0, 1] as const) {
        const { outward } = faceAxes(tile.face)
        const cube = outward.addScaledVector(first, x).addScaledVector(second, y)
        const point = cubeToEllipsoid(cube, earth.radii, new Vector3())
        const height = interpolated(tile, x, y, morph)
        point.addScaledVector(earth.surfaceNormal(point), height)
        if (isHidden(drawn, point, morph)) continue
        throw new Error(
          `${longitude}°, ${latitude}°, ${clearance} m: tile ${n}, level ${tile.level}, is seen`
        )
      }
    }
  }
  // From among mountains a good part of them.
  expect(hidden / all).toBeGreaterThan(0.2)
})

it('knows nothing of tiles without heights', () => {
  const drawn = new Drawn(1, 47, 2, 0)
  for (const tile of drawn.all) tile.heights = null
  const before = [...drawn.selection.tiles]
  new TerrainHorizon().cull(drawn.selection, drawn.viewer, earth, RESOLUTION)
  expect(drawn.selection.tiles).toEqual(before)
  expect(drawn.selection.inView).toBe(drawn.all.length)
})
