import { airglow, Atmosphere, milkyWay, moon, stars } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { PerspectiveCamera } from 'three'
import { expect, it } from 'vitest'
import { GlobeNight } from '../src/globe/GlobeNight'

it('has stars, moon and airglow in a night as they were switched before it fell, and after', () => {
  const atmosphere = new Atmosphere({ frame: 'ecef' })
  const camera = new PerspectiveCamera()
  Ellipsoid.WGS84.geodeticToECEF({ longitude: 0, latitude: 30, height: 10 }, camera.position)
  camera.updateMatrixWorld()
  const sky = [milkyWay(), stars(), moon(), airglow()] as const
  let nights = 0
  const night = new GlobeNight(atmosphere, () => {
    nights++
    return { sky, lights: [] }
  })
  const strengths = (): number[] => {
    const [galaxy, starlight, luna, glow] = sky
    return [galaxy.intensity, starlight.intensity, luna.strength, glow.intensity]
  }
  night.show({ stars: false, moon: false, airglow: true })
  atmosphere.date = new Date('2026-06-21T12:00:00Z')
  night.update(camera)
  expect(nights).toBe(0)
  atmosphere.date = new Date('2026-06-21T23:59:00Z')
  night.update(camera)
  night.update(camera)
  expect(nights).toBe(1)
  expect(strengths()).toEqual([0, 0, 0, 1])
  night.show({ stars: true, moon: true, airglow: false })
  expect(strengths()).toEqual([1, 1, 1, 0])
  night.dispose()
  atmosphere.dispose()
})
