import { Atmosphere } from '@welkin/atmosphere'
import { GridHeights, Lake, Terrain, Walker } from '@welkin/terrain'
import { Raycaster, Vector3 } from 'three'
import { expect, it } from 'vitest'

const middle = { longitude: 8.6, latitude: 47.2 }
const heights = new GridHeights(new Float32Array(16).fill(380), {
  width: 4,
  height: 4,
  west: 8,
  east: 9,
  south: 46.8,
  north: 47.6,
  outside: 380
})

it('lies at its level, bends with the planet, and knows how deep it is', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const { ellipsoid } = atmosphere
  const terrain = new Terrain(atmosphere, heights, { resolution: 4 })
  const lake = new Lake(terrain, { ...middle, radius: 20_000, level: 406 })
  const { position, normal, depth } = lake.geometry.attributes
  const point = new Vector3()
  const up = new Vector3()
  // Greatest of all points': so many expectations would take seconds.
  const most = { height: 0, normal: 0, depth: 0 }
  let farthest = 0
  for (let i = 0; i < position.count; i++) {
    point.fromBufferAttribute(position, i).applyMatrix4(lake.matrixWorld)
    most.height = Math.max(most.height, Math.abs(ellipsoid.heightAt(point) - 406))
    const off = up.fromBufferAttribute(normal, i).distanceTo(ellipsoid.surfaceNormal(point))
    most.normal = Math.max(most.normal, off)
    most.depth = Math.max(most.depth, Math.abs(depth.getX(i) - 26))
    farthest = Math.max(farthest, point.distanceTo(lake.center))
  }
  // Float32 has 20 km to 1 mm.
  expect(most.height).toBeLessThan(5e-3)
  expect(most.normal).toBeLessThan(1e-6)
  expect(most.depth).toBeLessThan(5e-4)
  expect(farthest).toBeGreaterThan(19_900)
  expect(farthest).toBeLessThan(20_010)
  // All triangles face up.
  const corners = [0, 1, 2].map(() => new Vector3())
  const { index } = lake.geometry
  let least = Infinity
  for (let i = 0; i < index!.count; i += 3) {
    for (const [n, corner] of corners.entries()) {
      corner.fromBufferAttribute(position, index!.getX(i + n))
    }
    const [a, b, c] = corners
    const facing = b.sub(a).cross(c.sub(a)).dot(up.fromBufferAttribute(normal, 0))
    least = Math.min(least, facing)
  }
  expect(least).toBeGreaterThan(0)
})

it('follows a world that is placed anywhere, in any units', () => {
  const atmosphere = new Atmosphere()
  atmosphere.place(middle)
  atmosphere.metersPerUnit = 1000
  const terrain = new Terrain(atmosphere, heights, { resolution: 4 })
  const lake = new Lake(terrain, { ...middle, radius: 500, level: 406 })
  const at = (): Vector3 => new Vector3().setFromMatrixPosition(lake.matrixWorld)
  expect(at().distanceTo(new Vector3(0, 0.406, 0))).toBeLessThan(1e-6)
  atmosphere.place({ ...middle, height: 400 })
  lake.onBeforeRender()
  expect(at().distanceTo(new Vector3(0, 0.006, 0))).toBeLessThan(1e-6)
})

it('is the surface that one asks for, that rays hit and that a walker swims in, as long as it is there', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const { ellipsoid } = atmosphere
  const terrain = new Terrain(atmosphere, heights, { resolution: 4 })
  const other = new Lake(terrain, { ...middle, radius: 500, level: 390 })
  const lake = new Lake(terrain, { ...middle, radius: 2000, level: 406 })
  const within = { longitude: middle.longitude, latitude: 47.2175 } // 1,946 m north
  const beyond = { longitude: middle.longitude, latitude: 47.2185 }
  const heightAt = ({ longitude, latitude }: typeof middle): number =>
    terrain.heightAt(longitude, latitude)
  for (const place of [middle, within]) expect(heightAt(place)).toBe(406)
  expect(heightAt(beyond)).toBeCloseTo(380, 6)
  expect(heightAt({ longitude: middle.longitude - 180, latitude: -middle.latitude })).toBe(380)

  const eye = ellipsoid.geodeticToECEF({ ...within, height: 5000 })
  const up = ellipsoid.surfaceNormal(eye)
  const [hit] = new Raycaster(eye, up.clone().negate()).intersectObject(terrain)
  expect(hit.distance).toBeCloseTo(4594, 3)
  expect(hit.normal!.distanceTo(up)).toBeLessThan(1e-9)

  const walker = new Walker(terrain).moveTo(ellipsoid.geodeticToECEF({ ...within, height: 410 }))
  for (let i = 0; i < 20; i++) walker.update(new Vector3(), false, 1)
  expect(walker.state).toBe('swimming')
  expect(walker.height).toBeCloseTo(406 - 0.85 * 1.7, 3)

  lake.dispose()
  expect(heightAt(within)).toBeCloseTo(380, 6)
  expect(heightAt(middle)).toBe(390)
  for (const each of [other, lake]) each.dispose()
  expect(heightAt(middle)).toBeCloseTo(380, 6)
})
