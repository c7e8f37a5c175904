import fc from 'fast-check'
import { Matrix4, OrthographicCamera, PerspectiveCamera, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Ellipsoid, fitGlobeCamera } from '@welkin/geo'
import type { DepthKind } from '@welkin/geo'
import { direction, latitude, longitude, magnitude, number, runs } from './arbitraries'

const earth = Ellipsoid.WGS84
const lowest = earth.grown(-500)

function look(
  camera: PerspectiveCamera | OrthographicCamera,
  viewpoint: Vector3,
  at: Vector3
): void {
  camera.position.copy(viewpoint)
  // three's lookAt() wants an up that is not along the view.
  const view = at.clone().sub(viewpoint).normalize()
  const up = earth.surfaceNormal(viewpoint)
  const north = new Vector3(0, 1, 0).transformDirection(earth.eastNorthUpFrame(viewpoint))
  camera.up.copy(Math.abs(view.dot(up)) < 0.7 ? up : north)
  camera.lookAt(at)
  camera.updateMatrixWorld(true)
}

/** A point of the ground on either side of the horizon, as the camera sees it. */
const ground = fc.record({
  distance: magnitude(1, 1.2e6),
  azimuth: number(0, 2 * Math.PI),
  height: number(-500, 9000)
})

function placeGround(
  viewpoint: Vector3,
  { distance, azimuth, height }: { distance: number; azimuth: number; height: number }
): Vector3 {
  const scale = Math.max(1, earth.heightAt(viewpoint) / 1e5)
  const beside = new Vector3(Math.sin(azimuth), Math.cos(azimuth), 0)
    .multiplyScalar(distance * scale)
    .applyMatrix4(earth.eastNorthUpFrame(earth.footPoint(viewpoint)))
  const { longitude, latitude } = earth.ecefToGeodetic(beside)
  return earth.geodeticToECEF({ longitude, latitude, height })
}

function isHidden(viewpoint: Vector3, point: Vector3): boolean {
  const ray = point.clone().sub(viewpoint)
  const hit = lowest.intersectRayDistance(viewpoint, ray)
  return hit !== null && hit < ray.length() - 1
}

describe.each<DepthKind>(['standard', 'reversed', 'logarithmic'])('%s depth', depth => {
  it('holds all ground that the picture shows, from 1 m to 10 radii', () => {
    let seen = 0
    fc.assert(
      fc.property(
        longitude,
        latitude,
        magnitude(1, 6.4e7),
        ground,
        number(10, 110),
        (lon, lat, height, at, fov) => {
          const viewpoint = earth.geodeticToECEF({ longitude: lon, latitude: lat, height })
          // Below the highest mountains, the nearest ground is where the camera stands.
          const point = placeGround(
            viewpoint,
            height > 9000 ? at : { ...at, height: Math.min(at.height, 0) }
          )
          if (isHidden(viewpoint, point)) return
          const camera = new PerspectiveCamera(fov, 16 / 9)
          look(camera, viewpoint, point.clone().multiplyScalar(0.999).lerp(viewpoint, 0.1))
          fitGlobeCamera(camera, { depth })
          const view = point.clone().applyMatrix4(camera.matrixWorldInverse)
          const clip = view.clone().applyMatrix4(camera.projectionMatrix)
          if (Math.abs(clip.x) > 1 || Math.abs(clip.y) > 1) return
          seen += 1
          expect(-view.z).toBeGreaterThan(camera.near)
          expect(-view.z).toBeLessThan(camera.far)
        }
      ),
      { ...runs, numRuns: 2000 }
    )
    expect(seen).toBeGreaterThan(300)
  })

  it('moves smoothly with altitude', () => {
    const camera = new PerspectiveCamera(50, 1.6)
    let previous: { near: number; far: number } | null = null
    for (let height = 1; height < 6.4e7; height *= 1.02) {
      look(camera, new Vector3(earth.a + height, 0, 0), new Vector3())
      fitGlobeCamera(camera, { depth })
      const { near, far } = camera
      expect(near).toBeLessThan(far / 1.05)
      if (previous !== null) {
        expect(far / previous.far).toBeGreaterThanOrEqual(1)
        expect(far / previous.far).toBeLessThan(1.021)
        expect(near).toBeGreaterThanOrEqual(previous.near)
        expect(near - previous.near).toBeLessThan(0.02 * height + 1e-9)
      }
      previous = { near, far }
    }
  })
})

it('shows Mount Everest’s height behind the horizon from 2 m up', () => {
  const camera = new PerspectiveCamera()
  look(camera, new Vector3(earth.a + 2, 0, 0), new Vector3(earth.a, 0, 1e5))
  fitGlobeCamera(camera)
  // 3.57 km √h for the peak alone.
  expect(camera.far).toBeGreaterThan(3570 * Math.sqrt(8849))
  expect(camera.far).toBeLessThan(6e5)
  expect(camera.near).toBe(0.5)
})

it('gives near to what is known to be far', () => {
  const camera = new PerspectiveCamera(60, 1)
  look(camera, new Vector3(earth.a + 2000, 0, 0), new Vector3())
  fitGlobeCamera(camera, { clearance: 1000 })
  // cos of half the diagonal: 1 / √(1 + 2 tan² 30°).
  expect(camera.near).toBeCloseTo(990 / Math.sqrt(1 + 2 / 3), 6)
  fitGlobeCamera(camera, { depth: 'reversed', minimumNear: 0.2 })
  expect(camera.near).toBe(0.2)
  Object.assign(camera, { _reversedDepth: true }) // as a renderer with a reversed depth buffer sets it
  fitGlobeCamera(camera)
  expect(camera.near).toBe(0.1)
})

it('works in other world frames and units', () => {
  const viewpoint = earth.geodeticToECEF({ longitude: 139.77, latitude: 35.68, height: 5e4 })
  const ecef = new PerspectiveCamera()
  look(ecef, viewpoint, new Vector3())
  fitGlobeCamera(ecef)
  const local = new PerspectiveCamera()
  const worldToECEF = earth
    .localYUpFrame(viewpoint)
    .multiply(new Matrix4().makeScale(1000, 1000, 1000))
  fitGlobeCamera(local, { worldToECEF })
  expect(local.near * 1000).toBeCloseTo(ecef.near, 4)
  expect(local.far * 1000).toBeCloseTo(ecef.far, 2)
})

it('updates the projection, and only when it must', () => {
  const camera = new PerspectiveCamera()
  look(camera, new Vector3(earth.a + 1e6, 0, 0), new Vector3())
  fitGlobeCamera(camera)
  const fresh = new PerspectiveCamera(camera.fov, camera.aspect, camera.near, camera.far)
  expect(camera.projectionMatrix.elements).toEqual(fresh.projectionMatrix.elements)
  camera.updateProjectionMatrix = () => expect.unreachable()
  fitGlobeCamera(camera)
})

it('gives an orthographic camera the whole globe', () => {
  fc.assert(
    fc.property(direction, direction, (from, point) => {
      const camera = new OrthographicCamera(-1e7, 1e7, 1e7, -1e7)
      look(camera, from.clone().multiplyScalar(5e7), new Vector3())
      fitGlobeCamera(camera)
      const summit = point.clone().multiply(earth.grown(9000).radii)
      const depth = -summit.applyMatrix4(camera.matrixWorldInverse).z
      expect(depth).toBeGreaterThan(camera.near - 1)
      expect(depth).toBeLessThan(camera.far + 1)
      expect(camera.far - camera.near).toBeLessThan(2.01 * earth.a)
    }),
    runs
  )
})
