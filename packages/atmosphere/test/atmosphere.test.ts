import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { Camera, Euler, Quaternion, Vector3 } from 'three'
import {
  Atmosphere,
  AtmosphereParameters,
  SkyLightProbe,
  SunDirectionalLight,
  distanceFog,
  heightFog,
  skyBackground,
  skyLuminanceAt,
  moon,
  sunFlare,
  skyIlluminanceAt,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import type { AtmosphereFrame } from '@welkin/atmosphere'
import { Ellipsoid, type GeodeticLike, sunDirectionECEF } from '@welkin/geo'
import { number, runs } from './arbitraries'

const degree = Math.PI / 180
/** Sun over longitude 0 by the almanac's equation of time, on the day of the equinox. */
const equinoxNoon = new Date('2026-03-20T12:07:30Z')

describe('Atmosphere', () => {
  it('keeps its layers in order, each once, and tells when they change', () => {
    const atmosphere = new Atmosphere()
    const node = skyBackground(atmosphere)
    const key = (): number => node.getCacheKey()
    const [near, far] = [heightFog(), distanceFog()]
    const bare = key()
    expect(key()).toBe(bare)
    expect(atmosphere.add(near)).toBe(atmosphere)
    const one = key()
    expect(one).not.toBe(bare)
    expect(key()).toBe(one)
    expect(() => atmosphere.add(far, near)).toThrow('in the sky already, got a HeightFog')
    expect(() => atmosphere.add(far, far)).toThrow('in the sky already, got a DistanceFog')
    atmosphere.remove(near).add(far, near)
    expect(atmosphere.layers).toEqual([far, near])
    expect(atmosphere.remove(far).layers).toEqual([near])
    const { layersVersion } = atmosphere
    expect(atmosphere.remove(far).layersVersion).toBe(layersVersion)
    // As many as before, but another one.
    const before = key()
    atmosphere.remove(near).add(far)
    expect(key()).not.toBe(before)
  })

  it('takes no layer that is none, nor any of those with it', () => {
    const atmosphere = new Atmosphere()
    for (const wrong of [null, undefined, 'abc', 3, heightFog, [heightFog()]]) {
      expect(() => atmosphere.add(heightFog(), wrong as never)).toThrow(
        'Atmosphere.add: layer must be a SkyLayer or forwardShafts(), got '
      )
    }
    expect(() => atmosphere.add(sunFlare(), moon().attach(new Atmosphere()))).toThrow(
      'Moon.attach: atmosphere must be the one that it was added to before'
    )
    expect(atmosphere.layers).toEqual([])
  })

  it('sees the equinox sun at noon overhead at the equator and due south at 45° north', () => {
    const atmosphere = new Atmosphere()
    atmosphere.date = equinoxNoon
    atmosphere.place({ longitude: 0, latitude: 0 })
    expect(atmosphere.sunDirection.angleTo(new Vector3(0, 1, 0))).toBeLessThan(0.2 * degree)
    atmosphere.place({ longitude: 0, latitude: 45 })
    const south = new Vector3(0, 1, 1).normalize()
    expect(atmosphere.sunDirection.angleTo(south)).toBeLessThan(0.2 * degree)
    atmosphere.place({ longitude: 90, latitude: 0 })
    expect(atmosphere.sunDirection.angleTo(new Vector3(-1, 0, 0))).toBeLessThan(0.2 * degree)
  })

  it('has one sun in every frame', () => {
    fc.assert(
      fc.property(
        number(-180, 180),
        number(-89, 89),
        number(0, 3e10),
        (longitude, latitude, ms) => {
          const date = new Date(1.77e12 + Math.floor(ms))
          const local = new Atmosphere().place({ longitude, latitude })
          const global = new Atmosphere()
          global.frame = 'ecef'
          local.metersPerUnit = 1000
          local.date = global.date = date
          const expected = sunDirectionECEF(date)
          expect(global.sunDirection.angleTo(expected)).toBeLessThan(1e-7)
          const turned = local.sunDirection.transformDirection(local.worldToECEF)
          expect(turned.distanceTo(expected)).toBeLessThan(1e-9)
        }
      ),
      { ...runs, numRuns: 60 }
    )
  })

  it('puts the origin at the place, in units of its own', () => {
    const atmosphere = new Atmosphere()
    atmosphere.metersPerUnit = 1000
    atmosphere.place({ longitude: 139.77, latitude: 35.68, height: 40 })
    const up = new Vector3(0, 2, 0).applyMatrix4(atmosphere.worldToECEF)
    const place = Ellipsoid.WGS84.ecefToGeodetic(up)
    expect(place.longitude).toBeCloseTo(139.77, 9)
    expect(place.latitude).toBeCloseTo(35.68, 9)
    expect(place.height).toBeCloseTo(2040, 4)
    atmosphere.frame = 'ecef'
    expect(new Vector3(1, 2, 3).applyMatrix4(atmosphere.worldToECEF).toArray()).toEqual([
      1e3, 2e3, 3e3
    ])
  })

  it('points the sun by angles in both frames', () => {
    const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 50 })
    atmosphere.setSunAngles(30, 90)
    const east = new Vector3(Math.cos(30 * degree), 0.5, 0)
    expect(atmosphere.sunDirection.distanceTo(east)).toBeLessThan(1e-9)
    const expected = east.clone().transformDirection(atmosphere.worldToECEF)
    atmosphere.frame = 'ecef'
    atmosphere.setSunAngles(30, 90)
    expect(atmosphere.sunDirection.distanceTo(expected)).toBeLessThan(1e-9)
    atmosphere.frame = 'local'
    atmosphere.setSunAngles(0, 0)
    expect(atmosphere.sunDirection.distanceTo(new Vector3(0, 0, -1))).toBeLessThan(1e-9)
  })

  it('points the sun by angles from the origin of a world set by hand', () => {
    fc.assert(
      fc.property(
        number(-180, 180),
        number(-89, 89),
        number(-90, 90),
        number(0, 360),
        number(0.01, 100),
        (longitude, latitude, elevation, azimuth, unit) => {
          const atmosphere = new Atmosphere().place({ longitude: 20, latitude: 50 })
          const origin = Ellipsoid.WGS84.geodeticToECEF({ longitude, latitude, height: 300 })
          // A tile set that was turned and scaled, with its origin somewhere on the globe.
          const turn = new Quaternion().setFromEuler(new Euler(latitude, elevation, longitude))
          atmosphere.worldToECEF.compose(origin, turn, new Vector3(unit, unit, unit))
          atmosphere.setSunAngles(elevation, azimuth)
          const sun = atmosphere.sunDirection.transformDirection(atmosphere.worldToECEF)
          const up = Ellipsoid.WGS84.surfaceNormal(origin)
          expect(sun.dot(up)).toBeCloseTo(Math.sin(elevation * degree), 9)
          const frame = Ellipsoid.WGS84.eastNorthUpFrame(origin)
          const [east, north] = [0, 1].map(i => new Vector3().setFromMatrixColumn(frame, i))
          const level = Math.cos(elevation * degree)
          expect(sun.dot(east)).toBeCloseTo(level * Math.sin(azimuth * degree), 9)
          expect(sun.dot(north)).toBeCloseTo(level * Math.cos(azimuth * degree), 9)
        }
      ),
      { ...runs, numRuns: 60 }
    )
  })

  it('keeps the sun where it is when the date is taken away', () => {
    const atmosphere = new Atmosphere().place({ longitude: 7, latitude: 50 })
    atmosphere.date = equinoxNoon
    const before = atmosphere.sunDirection
    atmosphere.date = null
    expect(atmosphere.sunDirection.distanceTo(before)).toBe(0)
    atmosphere.date = equinoxNoon
    atmosphere.sunDirection = new Vector3(0, 5, 0)
    expect(atmosphere.date).toBeNull()
    expect(atmosphere.sunDirection.toArray()).toEqual([0, 1, 0])
  })

  it('keeps a date of its own', () => {
    const date = new Date('2026-06-21T03:00:00Z')
    const atmosphere = new Atmosphere()
    atmosphere.date = date
    const before = atmosphere.sunDirection
    date.setUTCHours(12)
    atmosphere.date.setUTCHours(15)
    expect(atmosphere.date.toISOString()).toBe('2026-06-21T03:00:00.000Z')
    expect(atmosphere.sunDirection.equals(before)).toBe(true)
  })

  it('refuses air that does not belong to the ellipsoid', () => {
    const ellipsoid = new Ellipsoid(3_389_500, 3_389_500, 3_389_500)
    expect(() => new Atmosphere({ ellipsoid })).toThrow(
      'Atmosphere: bottomRadius must be near that of the ellipsoid, got 6378137'
    )
    const parameters = new AtmosphereParameters({ bottomRadius: 3_389_500, topRadius: 3_500_000 })
    expect(new Atmosphere({ ellipsoid, parameters }).ellipsoid).toBe(ellipsoid)
  })

  it('refuses what makes no sense, by name and value', () => {
    const atmosphere = new Atmosphere()
    const light = new SunDirectionalLight(atmosphere, 2)
    const missing = undefined as never
    const wrong: [() => unknown, RegExp][] = [
      [() => (atmosphere.date = new Date(NaN)), /Atmosphere: date .*Invalid Date/],
      [() => (atmosphere.date = 'noon' as unknown as Date), /Atmosphere: date .*noon/],
      [() => (atmosphere.frame = 'eci' as AtmosphereFrame), /Atmosphere: frame .*eci/],
      [() => (atmosphere.metersPerUnit = 0), /Atmosphere: metersPerUnit .*0/],
      [() => (atmosphere.metersPerUnit = NaN), /Atmosphere: metersPerUnit .*NaN/],
      [() => (atmosphere.sunDirection = new Vector3()), /Atmosphere: sunDirection .*\(0, 0, 0\)/],
      [() => atmosphere.setSunAngles(91, 0), /Atmosphere.setSunAngles: elevation .*91/],
      [() => atmosphere.setSunAngles(0, Infinity), /Atmosphere.setSunAngles: azimuth .*Infinity/],
      [() => atmosphere.place({ longitude: 0, latitude: 91 }), /latitude .*91/],
      [() => atmosphere.place({ longitude: NaN, latitude: 0 }), /longitude .*NaN/],
      [
        () => sunIlluminanceAt(atmosphere, new Vector3(NaN, 0, 0)),
        /sunIlluminanceAt: position .*NaN/
      ],
      [
        () => skyIlluminanceAt(atmosphere, new Vector3(), new Vector3(0, 1, 0)),
        /skyIlluminanceAt: there are no tables.*bake/
      ],
      [
        () => skyLuminanceAt(atmosphere, new Vector3(), new Vector3(0, 1, 0)),
        /skyLuminanceAt: there are no tables.*bake/
      ],
      [
        () => new Atmosphere({ parameters: {} as AtmosphereParameters }),
        /Atmosphere: parameters must be AtmosphereParameters, got \{\}/
      ],
      [
        () => new Atmosphere({ ellipsoid: new Vector3() as unknown as Ellipsoid }),
        /Atmosphere: ellipsoid must be an Ellipsoid, got \(0, 0, 0\)/
      ],
      [() => (atmosphere.luminanceScale = 0), /Atmosphere: luminanceScale .*0/],
      [() => (atmosphere.luminanceScale = '1' as never), /Atmosphere: luminanceScale .*1/],
      [() => (atmosphere.bakeStepsPerFrame = 0), /Atmosphere: bakeStepsPerFrame .*0/],
      [() => (atmosphere.bakeStepsPerFrame = 1.5), /Atmosphere: bakeStepsPerFrame .*1\.5/],
      [() => (atmosphere.bakeStepsPerFrame = NaN), /Atmosphere: bakeStepsPerFrame .*NaN/],
      [() => (atmosphere.sunDirection = missing), /Atmosphere: sunDirection .*undefined/],
      [() => (atmosphere.date = missing), /Atmosphere: date .*undefined/],
      [() => (atmosphere.metersPerUnit = missing), /Atmosphere: metersPerUnit .*undefined/],
      [() => atmosphere.place(missing), /Atmosphere.place: geodetic .*undefined/],
      [() => atmosphere.place({ longitude: 3 } as GeodeticLike), /latitude .*undefined/],
      [() => sunIlluminanceAt(atmosphere, missing), /sunIlluminanceAt: position .*undefined/],
      [() => atmosphere.update(missing, new Camera()), /Atmosphere: renderer .*undefined/],
      [() => new SunDirectionalLight(missing), /SunDirectionalLight: atmosphere .*undefined/],
      [() => new SunDirectionalLight(atmosphere, NaN), /SunDirectionalLight: distance .*NaN/],
      [() => (light.distance = -1), /SunDirectionalLight: distance .*-1/],
      [() => new SkyLightProbe({} as Atmosphere), /SkyLightProbe: atmosphere .*got \{\}/],
      [() => skyBackground(missing), /SkyBackgroundNode: atmosphere .*undefined/]
    ]
    const before = [...atmosphere.worldToECEF.elements, ...atmosphere.sunDirection.toArray()]
    for (const [act, message] of wrong) expect(act).toThrow(message)
    expect([atmosphere.luminanceScale, atmosphere.bakeStepsPerFrame]).toEqual([1e-4, Infinity])
    expect(light.distance).toBe(2)
    expect([...atmosphere.worldToECEF.elements, ...atmosphere.sunDirection.toArray()]).toEqual(
      before
    )
  })
})
