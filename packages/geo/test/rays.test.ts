import fc from 'fast-check'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Ellipsoid } from '@welkin/geo'
import { direction, latitude, longitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84

describe('intersectRay', () => {
  it('falls straight down by the height, whatever the direction’s length', () => {
    fc.assert(
      fc.property(longitude, latitude, magnitude(0.01, 4e8), (lon, lat, height) => {
        const origin = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
        const down = earth.surfaceNormal(origin).multiplyScalar(-3)
        const distance = earth.intersectRayDistance(origin, down) ?? NaN
        expect(Math.abs(distance - height)).toBeLessThan(1e-6)
        const ground = earth.geodeticToECEF({ longitude: lon, latitude: lat })
        expect(earth.intersectRay(origin, down)?.distanceTo(ground)).toBeLessThan(1e-6)
      }),
      runs
    )
  })

  it('finds the point that a ray from outside was aimed at, unless the globe hides it', () => {
    fc.assert(
      fc.property(direction, magnitude(1.001, 60), direction, (from, distance, to) => {
        const origin = from.clone().multiplyScalar(distance * earth.a)
        const aim = to.clone().multiply(earth.radii)
        const ray = aim.clone().sub(origin)
        const hit = earth.intersectRay(origin, ray)
        const facing = earth.surfaceNormal(aim).dot(ray) / ray.length()
        if (facing < -1e-3) expect(hit?.distanceTo(aim)).toBeLessThan(1e-3)
        else if (facing > 1e-3) expect(hit?.distanceTo(origin)).toBeLessThan(ray.length())
        if (hit !== null) expect(Math.abs(earth.heightAt(hit))).toBeLessThan(1e-3)
        expect(earth.intersectRay(origin, from)).toBeNull()
      }),
      runs
    )
  })

  it('leaves from inside', () => {
    fc.assert(
      fc.property(direction, number(0, 0.99), direction, (from, distance, along) => {
        const origin = from.clone().multiplyScalar(distance * earth.b)
        const hit = earth.intersectRay(origin, along)
        expect(hit).not.toBeNull()
        expect(Math.abs(earth.heightAt(hit ?? origin))).toBeLessThan(1e-6)
        expect(hit?.clone().sub(origin).normalize().distanceTo(along)).toBeLessThan(1e-9)
      }),
      runs
    )
    expect(earth.intersectRayDistance(new Vector3(), new Vector3(1, 0, 0))).toBe(6378137)
  })

  it('misses above the horizon and hits below it', () => {
    // At the equator looking north from 2 m up the dip is √(2h / M), M = 6335439 m (NGA).
    const dip = Math.sqrt((2 * 2) / 6335439.3273)
    const origin = new Vector3(earth.a + 2, 0, 0)
    const at = (angle: number): Vector3 => new Vector3(-Math.sin(angle), 0, Math.cos(angle))
    expect(earth.intersectRay(origin, at(dip * 0.9999))).toBeNull()
    expect(earth.intersectRay(origin, at(dip * 1.0001))).not.toBeNull()
  })

  it('starts on the surface', () => {
    const origin = new Vector3(earth.a, 0, 0)
    expect(earth.intersectRayDistance(origin, new Vector3(-1, 0, 0))).toBeCloseTo(2 * earth.a, 6)
    expect(earth.intersectRayDistance(origin, new Vector3(1, 0, 0))).toBe(0)
  })
})
