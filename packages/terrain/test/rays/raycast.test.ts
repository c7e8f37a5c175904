import { Atmosphere } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import fc from 'fast-check'
import { Raycaster, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { MountainHeights } from '../../src/heights/MountainHeights'
import { distanceToGround } from '../../src/rays/distanceToGround'
import { Terrain } from '../../src/Terrain'
import { groundOf, RADIUS } from '../ground'

const flat = (height: number) => groundOf(() => height, [height, height], 0)

/** A cone about the north pole, 1,000 m high, in a plain 2,000 m below the ball. */
const STEEPNESS = 0.5
const TOP = RADIUS + 1000
const cone = groundOf(
  ({ x, y, z }) => {
    const level = Math.hypot(x, y)
    if (z < 0 || level > 0.01) return -2000
    return Math.max(TOP / (z + STEEPNESS * level) - RADIUS, -2000)
  },
  [-2000, 1000],
  0.52
)

/** Distance along a ray to a cone about Z, the nearest above the plain from a distance on; null for none. */
function distanceToCone(origin: Vector3, direction: Vector3, near: number): number | null {
  // (TOP − z)² = k² (x² + y²), along the ray.
  const k = STEEPNESS ** 2
  const [x, y, z] = [origin.x, origin.y, TOP - origin.z]
  const a = direction.z ** 2 - k * (direction.x ** 2 + direction.y ** 2)
  const b = -direction.z * z - k * (direction.x * x + direction.y * y)
  const c = z * z - k * (x * x + y * y)
  const root = Math.sqrt(Math.max(b * b - a * c, 0))
  const hits = [(-b - root) / a, (-b + root) / a].filter(distance => {
    const point = origin.clone().addScaledVector(direction, distance)
    return distance > near && point.z < TOP + 1e-6 && point.length() > RADIUS - 1999
  })
  return hits.length > 0 ? Math.min(...hits) : null
}

const part = fc.double({ min: -1, max: 1, noNaN: true })
const directions = fc
  .tuple(part, part, part)
  .map(([x, y, z]) => new Vector3(x, y, z))
  .filter(vector => vector.length() > 0.1)
  .map(vector => vector.normalize())

describe('a ray', () => {
  it('ends on a ball, from 2 m to 20,000 km', () => {
    const powers = fc.double({ min: 0.3, max: 7.3, noNaN: true })
    fc.assert(
      fc.property(directions, directions, powers, (place, direction, power) => {
        const origin = place.clone().multiplyScalar(RADIUS + 100 + 10 ** power)
        const expected = new Ellipsoid(RADIUS + 100).intersectRayDistance(origin, direction)
        const distance = distanceToGround(flat(100), origin, direction, 0, Infinity)
        // What passes within a micrometre may go either way.
        if (expected === null || distance === null) {
          const nearest = origin.clone().cross(direction).length() - RADIUS - 100
          expect(distance === expected || Math.abs(nearest) < 1e-3).toBe(true)
        } else {
          const cosine = Math.abs(direction.dot(origin.addScaledVector(direction, expected)))
          expect(Math.abs(distance - expected)).toBeLessThan(1e-3 + (1e-6 * RADIUS) / cosine)
        }
      }),
      { numRuns: 500 }
    )
  })

  it('ends on a cone', () => {
    const far = fc.double({ min: 0.2, max: 6, noNaN: true })
    const aims = fc.tuple(part, part)
    fc.assert(
      fc.property(directions, far, aims, (from, power, [x, y]) => {
        const aim = new Vector3(3000 * x, 3000 * y, 0)
        // Inside by more than what a ray may pass through.
        aim.z = TOP - STEEPNESS * Math.hypot(aim.x, aim.y) - 0.01 - 2e-8 * 10 ** power
        const upward = new Vector3(from.x, from.y, Math.abs(from.z))
        const origin = aim.clone().addScaledVector(upward, 10 ** power)
        const direction = upward.negate()
        const distance = distanceToGround(cone, origin, direction, 0, Infinity)
        if (origin.z < TOP - STEEPNESS * Math.hypot(origin.x, origin.y)) return
        // From the aim, where the closed form keeps its digits.
        const expected = 10 ** power + distanceToCone(aim, direction, -(10 ** power))!
        expect(distance).not.toBeNull()
        expect(Math.abs(distance! - expected)).toBeLessThan(0.001)
      }),
      { numRuns: 500 }
    )
  })

  it('passes a summit by a centimetre, and hits it a centimetre lower', () => {
    const origin = new Vector3(-4e5, 0, TOP)
    const direction = new Vector3(1, 0, 0)
    origin.z += 0.01
    expect(distanceToGround(cone, origin, direction, 0, 5e5)).toBeNull()
    origin.z -= 0.02
    expect(distanceToGround(cone, origin, direction, 0, 5e5)).toBeCloseTo(4e5 - 0.02, 2)
  })

  it('keeps to near and far, and leaves the ground that it begins in', () => {
    const origin = new Vector3(-10_000, 0, TOP - 500)
    const direction = new Vector3(1, 0, 0)
    expect(distanceToGround(cone, origin, direction, 0, Infinity)).toBeCloseTo(9000, 2)
    expect(distanceToGround(cone, origin, direction, 0, 8999)).toBeNull()
    expect(distanceToGround(cone, origin, direction, 8999, 9001)).toBeCloseTo(9000, 2)
    expect(distanceToGround(cone, origin, direction, 9500, Infinity)).toBeNull()
    const down = new Vector3(0, 0, -1)
    expect(distanceToGround(cone, new Vector3(0, 0, TOP - 50), down, 0, Infinity)).toBeNull()
    const up = new Vector3(0, 0, 1)
    expect(distanceToGround(cone, new Vector3(0, 0, TOP - 50), up, 0, Infinity)).toBeNull()
  })
})

describe('Terrain', () => {
  const atmosphere = new Atmosphere({ metersPerUnit: 1000 })
  atmosphere.place({ longitude: 1, latitude: 47 })
  const source = new MountainHeights({ seed: 1 })
  const terrain = new Terrain(atmosphere, source, { resolution: 4 })
  const { ellipsoid, worldToECEF } = atmosphere
  const clearanceAt = (position: Vector3): number => {
    const { longitude, latitude, height } = ellipsoid.ecefToGeodetic(position)
    return height - terrain.heightAt(longitude, latitude)
  }

  it('is hit first where a march in steps of 5 m finds it', () => {
    const bearing = fc.double({ min: 0, max: 2 * Math.PI, noNaN: true })
    const heights = fc.double({ min: 0.3, max: 3, noNaN: true })
    const pitches = fc.double({ min: -0.3, max: 0.05, noNaN: true })
    fc.assert(
      fc.property(bearing, heights, pitches, bearing, (heading, power, pitch, turn) => {
        const longitude = 1 + 0.1 * Math.cos(turn)
        const latitude = 47 + 0.1 * Math.sin(turn)
        const height = terrain.heightAt(longitude, latitude) + 10 ** power
        const origin = ellipsoid.geodeticToECEF({ longitude, latitude, height })
        const level = Math.cos(pitch)
        const direction = new Vector3(
          level * Math.sin(heading),
          level * Math.cos(heading),
          Math.sin(pitch)
        ).transformDirection(ellipsoid.eastNorthUpFrame(origin))
        const at = (distance: number): number =>
          clearanceAt(origin.clone().addScaledVector(direction, distance))
        const distance = distanceToGround(terrain, origin, direction, 0, 9000)
        const end = distance ?? 9000
        for (let way = 0; way < end; way += 5) expect(at(way)).toBeGreaterThan(-1e-3)
        if (distance !== null) expect(Math.abs(at(distance))).toBeLessThan(1e-3)
      }),
      { numRuns: 12 }
    )
  })

  it("answers three's Raycaster in the world's units, with a normal", () => {
    const raycaster = new Raycaster(new Vector3(3, 400, 2), new Vector3(0, -1, 0), 0, 1e4)
    const [hit, ...more] = raycaster.intersectObject(terrain)
    expect(more).toEqual([])
    expect(hit.object).toBe(terrain)
    expect(hit.face).toBeNull()
    const position = hit.point.clone().applyMatrix4(worldToECEF)
    expect(Math.abs(clearanceAt(position))).toBeLessThan(1e-3)
    expect(hit.distance).toBeCloseTo(hit.point.distanceTo(raycaster.ray.origin), 9)
    const { longitude, latitude } = ellipsoid.ecefToGeodetic(position)
    expect(hit.normal!.distanceTo(terrain.normalAt(longitude, latitude))).toBeLessThan(1e-6)
    raycaster.far = hit.distance - 1e-6
    expect(raycaster.intersectObject(terrain)).toEqual([])
    raycaster.far = Infinity
    raycaster.layers.set(3)
    expect(raycaster.intersectObject(terrain)).toEqual([])
  })

  it('is hit on the sea, and by rays in ECEF from orbit', () => {
    const sea = new Terrain(atmosphere, source, { resolution: 4, seaLevel: 12_000 })
    const origin = ellipsoid.geodeticToECEF({ longitude: 5, latitude: 40, height: 4e5 })
    const aim = ellipsoid.geodeticToECEF({ longitude: 9, latitude: 42, height: 12_000 })
    const hit = sea.intersectRay(origin, aim.clone().sub(origin))!
    expect(hit.distanceTo(aim)).toBeLessThan(0.002)
    const away = origin.clone()
    expect(sea.intersectRay(origin, away)).toBeNull()
    const grazing = ellipsoid.surfaceNormal(origin).cross(new Vector3(0, 0, 1))
    expect(sea.intersectRay(origin, grazing)).toBeNull()
    sea.dispose()
  })

  it('refuses rays that are none', () => {
    const origin = new Vector3(NaN, 0, 0)
    expect(() => terrain.intersectRay(origin, new Vector3(1, 0, 0))).toThrow('originECEF')
    expect(() => terrain.intersectRay(new Vector3(), new Vector3())).toThrow('directionECEF')
  })
})
