import fc from 'fast-check'
import { Object3D, Quaternion, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Atmosphere, MoonDirectionalLight, moon, SunDirectionalLight } from '@welkin/atmosphere'
import { cosine, number, runs } from '../arbitraries'

describe('SunDirectionalLight', () => {
  it('stands towards the sun from its target, wherever its parents are', () => {
    const atmosphere = new Atmosphere()
    const light = new SunDirectionalLight(atmosphere, 50)
    const [parent, carrier] = [new Object3D(), new Object3D()]
    parent.add(light)
    carrier.add(light.target)
    fc.assert(
      fc.property(cosine, number(1, 360), number(-1e4, 1e4), (elevation, azimuth, east) => {
        atmosphere.setSunAngles(60 * elevation, azimuth)
        parent.position.set(east, 3, -7)
        parent.quaternion.copy(new Quaternion(1, 2, 3, azimuth).normalize())
        parent.scale.setScalar(2)
        carrier.position.set(-east, 40, east / 3)
        for (const each of [parent, carrier]) each.updateMatrixWorld()
        const there = new Vector3().setFromMatrixPosition(light.matrixWorld)
        const offset = there.sub(carrier.position)
        expect(offset.length()).toBeCloseTo(50, 6)
        expect(offset.normalize().distanceTo(atmosphere.sunDirection)).toBeLessThan(1e-6)
      }),
      runs
    )
  })

  it('is copied with atmosphere, source and distance', () => {
    const atmosphere = new Atmosphere()
    const luna = moon()
    atmosphere.add(luna)
    const light = new SunDirectionalLight(atmosphere, 7, luna.source)
    light.intensity = 0.5
    const copy = light.clone()
    expect([copy.atmosphere, copy.source, copy.distance]).toEqual([atmosphere, luna.source, 7])
    expect(copy.intensity).toBe(0.5)
    expect(copy).not.toBe(light)
  })

  it('is the moon’s where that is its source', () => {
    const atmosphere = new Atmosphere()
    const luna = moon({ direction: new Vector3(0, 1, 0) })
    atmosphere.add(luna)
    const light = new MoonDirectionalLight(atmosphere, luna, 20)
    light.updateMatrixWorld()
    expect(light.position.y).toBeCloseTo(20, 6)
  })
})
