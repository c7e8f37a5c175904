import { PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { keepStand } from '../src/sandbox/keepStand'

/** Height, way from the top and angles of a camera over a planet whose top is the origin. */
function standOf(camera: PerspectiveCamera, radius: number) {
  const up = camera.position.clone().add(new Vector3(0, radius, 0))
  const height = up.length() - radius
  up.normalize()
  const pitch = Math.PI / 2 - camera.getWorldDirection(new Vector3()).angleTo(up)
  const roll = new Vector3(1, 0, 0).applyQuaternion(camera.quaternion).dot(up)
  const way = radius * up.angleTo(new Vector3(0, 1, 0))
  return { height, pitch, roll, way }
}

/** A camera on a planet, some way from its top [m], level in the plane of its up. */
function cameraAt(radius: number, height: number, way: number): PerspectiveCamera {
  const camera = new PerspectiveCamera()
  const angle = way / radius
  camera.position.set(0, Math.cos(angle), Math.sin(angle)).multiplyScalar(radius + height)
  camera.position.y -= radius
  camera.rotation.set(angle + 0.3, 0, 0)
  camera.updateMatrixWorld()
  return camera
}

it('keeps height, direction of view and way to the top of the planet', () => {
  for (const [radius, next] of [
    [6.36e6, 1.6e4],
    [1.6e4, 6.36e6],
    [6.36e6, 6.37e6],
    [6.36e6, 1e8]
  ]) {
    for (const height of [2.2, 400]) {
      const camera = cameraAt(radius, height, 500)
      const before = standOf(camera, radius)
      keepStand(camera, radius, next)
      const after = standOf(camera, next)
      expect(after.height).toBeCloseTo(before.height, 4)
      expect(after.pitch).toBeCloseTo(before.pitch, 5)
      expect(after.roll).toBeCloseTo(before.roll, 9)
      expect(after.way / before.way).toBeCloseTo(1, 2)
    }
  }
})

it('comes back by the same steps', () => {
  const camera = cameraAt(6.36e6, 30, 200)
  const { position, quaternion } = camera.clone()
  keepStand(camera, 6.36e6, 5e4)
  keepStand(camera, 5e4, 6.36e6)
  expect(camera.position.distanceTo(position)).toBeLessThan(1e-5)
  expect(camera.quaternion.angleTo(quaternion)).toBeLessThan(1e-6)
})

it('leads no farther around a small planet than half a radian, nor nearer than it was', () => {
  const camera = cameraAt(6.36e6, 1e5, 1e6)
  keepStand(camera, 6.36e6, 1.6e4)
  const { height, way } = standOf(camera, 1.6e4)
  expect([height, way / 1.6e4]).toEqual([expect.closeTo(1e5, 4), expect.closeTo(0.5, 6)])
})

it('stays over the top', () => {
  const camera = cameraAt(6.36e6, 1000, 0)
  keepStand(camera, 6.36e6, 1e4)
  expect(camera.position.toArray()).toEqual([0, expect.closeTo(1000, 5), 0])
})
