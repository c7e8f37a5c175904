import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera, Vector3 } from 'three'
import { expect, it } from 'vitest'
import { flyToPlace, moveCamera } from '../src/globe/places'
import { SIGHTS } from '../src/photogrammetry/places'
import { explore } from './explore'

it('flies from Manhattan to London without a jump, above the ground, and looks there as it should', async () => {
  const { camera, explorer, run } = explore({
    upAt: (position, target) => Ellipsoid.WGS84.surfaceNormal(position, target),
    heightAt: position => Ellipsoid.WGS84.heightAt(position),
    pole: new Vector3(0, 0, 1)
  })
  moveCamera(camera, SIGHTS.manhattan)
  const aim = moveCamera(new PerspectiveCamera(), SIGHTS.london)
  const way = camera.position.distanceTo(aim.position)
  const arrival = flyToPlace(explorer, camera, SIGHTS.london)
  let [longest, lowest, frames] = [0, Infinity, 0]
  const before = camera.position.clone()
  for (; explorer.isFlying; frames++) {
    run(1 / 60)
    longest = Math.max(longest, camera.position.distanceTo(before))
    lowest = Math.min(lowest, Ellipsoid.WGS84.heightAt(camera.position))
    before.copy(camera.position)
  }
  await arrival
  expect(frames).toBeGreaterThan(120)
  expect(longest / way).toBeLessThan(0.02)
  expect(lowest).toBeGreaterThan(250)
  expect(camera.position.distanceTo(aim.position)).toBeLessThan(0.01)
  expect(camera.quaternion.angleTo(aim.quaternion)).toBeLessThan(1e-4)
})
