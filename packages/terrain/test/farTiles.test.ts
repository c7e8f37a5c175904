import fc from 'fast-check'
import { Ellipsoid } from '@welkin/geo'
import { Matrix4, PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { MountainHeights } from '../src/heights/MountainHeights'
import { cubeToEllipsoid, faceAxes } from '../src/tiles/cpu/cubeSphere'
import { viewerOf } from '../src/tiles/cpu/viewer'
import { leastFootprint } from '../src/tiles/FarTiles'
import { noTiles, TileTree } from '../src/tiles/TileTree'

const earth = Ellipsoid.WGS84
const source = new MountainHeights({ seed: 513 })
const heightOf = (subpoint: Vector3): number =>
  source.sampleAt(subpoint, { height: 0, gradient: new Vector3() }).height

/** Lines of the picture. */
const LINES = 1080

const part = fc.double({ min: -1, max: 1, noNaN: true })
const views = fc.record({
  power: fc.double({ min: 2, max: 6, noNaN: true }),
  pitch: fc.double({ min: -1.5, max: 0.1, noNaN: true }),
  places: fc.array(fc.tuple(part, part, part, part, part), { minLength: 60, maxLength: 60 })
})

it('bounds what a pixel shows of a tile, and is no less than a tenth of it', () => {
  let closest = 0
  fc.assert(
    fc.property(views, ({ power, pitch, places }) => {
      const clearance = 10 ** power
      const subpoint = earth.geodeticToECEF({ longitude: 1, latitude: 47, height: 0 })
      const height = heightOf(subpoint) + clearance
      const position = earth.geodeticToECEF({ longitude: 1, latitude: 47, height })
      const camera = new PerspectiveCamera(60, 16 / 9, 1, 1e8)
      camera.quaternion.setFromRotationMatrix(earth.localYUpFrame(position, new Matrix4()))
      camera.rotateX(pitch)
      camera.position.copy(position)
      camera.updateMatrixWorld()
      const viewer = viewerOf(camera, position, clearance, source.lowest, new Matrix4(), earth, 0)
      const { seaLevel } = viewer
      const forward = camera.getWorldDirection(new Vector3())
      const pixel = (2 * Math.tan(Math.PI / 6)) / LINES
      const sight = { position, seaLevel, forward, pixel }
      const tree = new TileTree(earth, source, 17, 1.2)
      const { tiles } = tree.select(viewer, 3000, noTiles(), false)
      const inPicture = (point: Vector3): Vector3 => {
        const seen = point.clone().project(camera)
        return seen.set((seen.x * LINES * camera.aspect) / 2, (seen.y * LINES) / 2, seen.z)
      }
      for (const [n, [across, along, ...way]] of places.entries()) {
        const tile = tiles[(n * 7919) % tiles.length]
        if (tile === undefined) continue
        const least = leastFootprint(tile, sight)
        if (least === 0) continue
        const { outward, first, second } = faceAxes(tile.face)
        const { extent } = tile
        outward
          .addScaledVector(first, tile.x + across * extent)
          .addScaledVector(second, tile.y + along * extent)
        const foot = cubeToEllipsoid(outward, earth.radii, new Vector3())
        const point = foot
          .clone()
          .addScaledVector(earth.surfaceNormal(foot), Math.max(heightOf(foot), 0))
        const seen = inPicture(point)
        if (Math.abs(seen.y) > LINES / 2 || Math.abs(seen.x) > (LINES * camera.aspect) / 2) continue
        const step = new Vector3(...way).normalize().multiplyScalar(least / 100)
        const moved = 100 * inPicture(point.add(step)).setZ(0).distanceTo(seen.setZ(0))
        expect(moved).toBeLessThan(1.05)
        closest = Math.max(closest, moved)
      }
    }),
    { numRuns: 60 }
  )
  expect(closest).toBeGreaterThan(0.1)
})
