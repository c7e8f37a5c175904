import fc from 'fast-check'
import { Ellipsoid } from '@welkin/geo'
import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { viewerOf, type Viewer } from '../src/tiles/cpu/viewer'
import { cubeToEllipsoid, faceAxes } from '../src/tiles/cpu/cubeSphere'
import { morphStart } from '../src/tiles/tsl/tileVertex'
import { distanceTo, noTiles, TileTree } from '../src/tiles/TileTree'
import type { Tile } from '../src/tiles/Tile'
import { CAPACITY, PagedTiles } from '../src/pages/PagedTiles'
import { DEFAULTS } from '../src/TerrainOptions'

const earth = Ellipsoid.WGS84
const source = new MountainHeights({ seed: 1 })
const DETAIL = 1.2
const FINEST = 17

const heightOf = (subpoint: Vector3): number =>
  source.sampleAt(subpoint, { height: 0, gradient: new Vector3() }).height

/** Places anywhere: poles and the antimeridian as often as all else. */
const places = fc.record({
  longitude: fc.oneof(fc.double({ min: -180, max: 180, noNaN: true }), fc.constantFrom(-180, 180)),
  latitude: fc.oneof(fc.double({ min: -90, max: 90, noNaN: true }), fc.constantFrom(-90, 90, 35.3)),
  clearance: fc.double({ min: 0.3, max: 7.3, noNaN: true }).map(power => 10 ** power)
})
type Place = typeof places extends fc.Arbitrary<infer T> ? T : never

/** Viewer at a place, over ground and sea; with `planes` left out it sees all round. */
function viewerAt(place: Place, pitch = 0, isAllRound = true, sea = -Infinity): Viewer {
  const subpoint = earth.geodeticToECEF({ ...place, height: 0 })
  const height = Math.max(heightOf(subpoint), sea) + place.clearance
  const position = earth.geodeticToECEF({ ...place, height })
  const camera = new PerspectiveCamera(50, 1.6, 1, 1e8)
  camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, new Matrix4()))
  camera.rotateX(pitch)
  camera.position.copy(position)
  camera.updateMatrixWorld()
  const lowest = Math.max(source.lowest, sea)
  const viewer = viewerOf(camera, position, place.clearance, lowest, new Matrix4(), earth, 0, sea)
  return isAllRound ? { ...viewer, planes: [], horizon: Math.PI } : viewer
}

const treeOf = (): TileTree => new TileTree(earth, source, FINEST, DETAIL)
const select = (viewer: Viewer, most = 1e5, tree = treeOf()): Tile[] =>
  tree.select(viewer, most, noTiles(), false).tiles

/** Point of a face on the ellipsoid. */
function pointOf(face: number, x: number, y: number): Vector3 {
  const { outward, first, second } = faceAxes(face)
  outward.addScaledVector(first, x).addScaledVector(second, y)
  return cubeToEllipsoid(outward, earth.radii, outward)
}

it('has ground in all of an orthographic view, beyond the horizon of its camera too', () => {
  // From 300 m, 4,000 km across: at its edges the ground is 300 km lower.
  const position = earth.geodeticToECEF({ longitude: 11, latitude: 47, height: 300 })
  const camera = new OrthographicCamera(-2e6, 2e6, 1.5e6, -1.5e6, 1, 1e8)
  camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, new Matrix4()))
  camera.rotateX(-Math.PI / 2)
  camera.position.copy(position)
  camera.updateMatrixWorld()
  const viewer = viewerOf(camera, position, 300, source.lowest, new Matrix4(), earth, 0)
  const tiles = select(viewer)
  const up = earth.surfaceNormal(position)
  for (const longitude of [-10, 0, 11, 22, 30]) {
    const place = earth.geodeticToECEF({ longitude, latitude: 47 })
    expect(place.clone().sub(position).dot(up)).toBeLessThan(0)
    const has = tiles.some(({ edges }) => edges.every(edge => edge.dot(place) <= 1e-6))
    expect([longitude, has]).toEqual([longitude, true])
  }
})

it('covers every point of the planet once', () => {
  fc.assert(
    fc.property(places, place => {
      const tiles = select(viewerAt(place))
      // Areas on the cube are sums of powers of two: exact.
      const areas = tiles.reduce((sum, { extent }) => sum + 4 * extent ** 2, 0)
      expect(areas).toBe(24)
      expect(new Set(tiles.map(({ face, x, y }) => `${face} ${x} ${y}`)).size).toBe(tiles.length)
    }),
    { numRuns: 12 }
  )
})

it('covers every point once while pages arrive, with a page or that of the coarser tile', () => {
  const tree = treeOf()
  const viewer = viewerAt({ longitude: 1, latitude: 47, clearance: 300 })
  for (const [slot, root] of tree.roots.entries()) Object.assign(root, { slot, fade: 0 })
  const selection = noTiles()
  let slots = tree.roots.length
  let frames = 0
  for (tree.select(viewer, 1e5, selection); selection.lag > 0; frames++) {
    const { tiles, missing } = selection
    expect(tiles.reduce((sum, { extent }) => sum + 4 * extent ** 2, 0)).toBe(24)
    expect(tiles.every(({ slot, parent }) => slot >= 0 || parent!.slot >= 0)).toBe(true)
    for (const tile of missing.slice(0, 20)) tile.slot = slots++
    for (const tile of tiles) tile.show(frames, 0.5)
    tree.select(viewer, 1e5, selection)
  }
  const whole = select(viewer)
  expect(selection.tiles.length).toBe(whole.length)
  expect(selection.missing).toEqual([])
  // Twenty in a frame, and two frames to fade in.
  expect(frames).toBeLessThan(slots / 20 + 3 * FINEST)
})

it('lets neighbours meet: the finer one wholly morphed, the coarser one not at all', () => {
  const tree = treeOf()
  fc.assert(
    fc.property(places, place => {
      const viewer = viewerAt(place)
      const tiles = select(viewer, 1e5, tree)
      /** Tiles by their point nearest to an edge's middle. */
      const morphAt = (tile: Tile, point: Vector3): number => {
        const part = point.distanceTo(viewer.datumPoint) / tree.ranges[tile.level]
        const start = morphStart(DETAIL)
        return Math.min(Math.max((part - start) / (1 - start), 0), 1)
      }
      const holds = (tile: Tile, face: number, x: number, y: number): boolean =>
        tile.face === face &&
        Math.abs(tile.x - x) <= tile.extent &&
        Math.abs(tile.y - y) <= tile.extent
      for (const tile of tiles.slice(-200)) {
        const beyond = tile.extent * (1 + 2 ** -20)
        const [x, y] = [tile.x + beyond, tile.y + 0.3 * tile.extent]
        if (x > 1) continue
        const neighbour = tiles.find(other => other !== tile && holds(other, tile.face, x, y))!
        expect(Math.abs(neighbour.level - tile.level)).toBeLessThan(2)
        if (neighbour.level === tile.level) continue
        const shared = pointOf(tile.face, tile.x + tile.extent, y)
        const [fine, coarse] = neighbour.level > tile.level ? [neighbour, tile] : [tile, neighbour]
        expect(morphAt(fine, shared)).toBe(1)
        expect(morphAt(coarse, shared)).toBe(0)
      }
    }),
    { numRuns: 8 }
  )
})

it('leaves out nothing that can be seen', () => {
  const tree = treeOf()
  const ray = new Vector3()
  fc.assert(
    fc.property(places, fc.double({ min: -1.5, max: 0.2, noNaN: true }), (place, pitch) => {
      const viewer = viewerAt(place, pitch, false, 0)
      const tiles = select(viewer, 1e5, tree)
      const all = select({ ...viewer, planes: [], horizon: Math.PI }, 1e5, tree)
      const chosen = new Set(tiles)
      const core = earth
      for (const { center, normal } of all.filter(tile => !chosen.has(tile))) {
        const ground = center.clone().addScaledVector(normal, Math.max(heightOf(center), 0))
        ray.copy(ground).sub(viewer.position)
        const isInView = viewer.planes.every(plane => plane.distanceToPoint(ray) > 0)
        const hidden = core.intersectRayDistance(viewer.position, ray)
        expect(isInView && (hidden === null || hidden > ray.length())).toBe(false)
      }
    }),
    { numRuns: 12 }
  )
})

it('keeps within its room, and forgets tiles that are left behind', () => {
  const tree = treeOf()
  const here = viewerAt({ longitude: 1, latitude: 47, clearance: 2 })
  expect(select(here, 100, tree).length).toBeLessThanOrEqual(100)
  const count = (tile: Tile): number =>
    1 + (tile.children ?? []).reduce((sum, child) => sum + count(child), 0)
  const total = (): number => tree.roots.reduce((sum, root) => sum + count(root), 0)
  const levels = select(here, 1e5, tree).map(({ level }) => level)
  expect(Math.max(...levels)).toBe(FINEST)
  const before = total()
  const there = viewerAt({ longitude: -120, latitude: -30, clearance: 2e7 })
  for (let i = 0; i < 600; i++) select(there, 1e5, tree)
  expect(total()).toBeLessThan(before / 10)
})

it('finds the distance to a tile from below', () => {
  const [tile] = treeOf().roots
  const point = earth.geodeticToECEF({ longitude: 30, latitude: 10, height: 1e6 })
  for (let x = -1; x <= 1; x += 0.25) {
    for (let y = -1; y <= 1; y += 0.25) {
      expect(distanceTo(tile, point)).toBeLessThanOrEqual(pointOf(0, x, y).distanceTo(point))
    }
  }
})

it.each([
  ['a summit', 0.428, 47.372, 200],
  ['a meadow', 0.494, 46.35, 338]
])(
  'has room for all pages of the view on %s, with shadows of 3 km about',
  (_name, longitude, latitude, heading) => {
    const mountains = new MountainHeights({ seed: 513 })
    const resolution = 12
    const subpoint = earth.geodeticToECEF({ longitude, latitude })
    const height = mountains.sampleAt(subpoint, { height: 0, gradient: new Vector3() }).height + 1.7
    const camera = new PerspectiveCamera(60, 16 / 9, 0.1, 1e8)
    earth.geodeticToECEF({ longitude, latitude, height }, camera.position)
    camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(camera.position, new Matrix4()))
    camera.rotateY((-heading * Math.PI) / 180)
    camera.rotateX(-0.14)
    camera.updateMatrixWorld()
    const viewer = viewerOf(camera, camera.position, 1.7, 0, new Matrix4(), earth, 3000, 0)
    const { tree, pages } = new PagedTiles(mountains, earth, {
      ...DEFAULTS,
      resolution,
      detail: DETAIL
    })
    const selection = noTiles()
    let count = 0
    do {
      tree.select(viewer, CAPACITY, selection)
      for (const tile of selection.missing) Object.assign(tile, { slot: 0, fade: 0 })
      count += selection.missing.length
    } while (selection.missing.length > 0)
    expect(selection.inView).toBeGreaterThan(400)
    // Tiles out of view, which cast shadows, take little of it.
    expect(selection.tiles.length).toBeLessThan(1.6 * selection.inView)
    expect(count).toBeLessThan(0.95 * pages.atlas.capacity)
    pages.dispose()
  }
)
