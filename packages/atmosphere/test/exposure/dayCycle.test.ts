import fc from 'fast-check'
import { PerspectiveCamera, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { Atmosphere, DayCycle, exposureFor, exposureOfIlluminance } from '@welkin/atmosphere'
import { Ellipsoid } from '@welkin/geo'
import { number, runs } from '../arbitraries'
import { solvedLight } from '../solvedLight'

const DAY = 86_400_000
const noon = new Date('2026-06-21T12:00:00Z')

describe('DayCycle', () => {
  it('moves the date at its rate', () => {
    const atmosphere = new Atmosphere()
    const cycle = new DayCycle(atmosphere, { date: noon, rate: 1440 })
    cycle.update(10)
    expect(atmosphere.date?.toISOString()).toBe('2026-06-21T16:00:00.000Z')
    cycle.paused = true
    cycle.update(10)
    expect(cycle.hour).toBeCloseTo(16, 9)
    cycle.paused = false
    cycle.rate = -3600
    cycle.update(1)
    expect(cycle.hour).toBeCloseTo(15, 9)
  })

  it('is one number', () => {
    const first = new DayCycle(new Atmosphere(), { date: noon, rate: 500, daylight: 0.7 })
    first.update(7.3)
    const second = new DayCycle(new Atmosphere(), { rate: 500, daylight: 0.7 })
    second.time = Number(String(first.time))
    first.update(3.1)
    second.update(3.1)
    expect(second.time).toBe(first.time)
  })

  it('takes as long for a day however it is skewed and cut into steps', () => {
    fc.assert(
      fc.property(
        number(0.05, 0.95),
        number(0, 24),
        number(-180, 180),
        fc.integer({ min: 1, max: 40 }),
        (daylight, hour, longitude, steps) => {
          const atmosphere = new Atmosphere().place({ longitude, latitude: 30 })
          const date = new Date(noon.getTime() + hour * 3.6e6)
          const cycle = new DayCycle(atmosphere, { date, rate: 864, daylight })
          for (let i = 0; i < steps; i++) cycle.update(100 / steps)
          expect(Math.abs(cycle.time - date.getTime() - DAY)).toBeLessThan(1)
        }
      ),
      { ...runs, numRuns: 60 }
    )
  })

  it('makes days as long as asked', () => {
    const cycle = new DayCycle(new Atmosphere(), { date: noon, rate: 864, daylight: 0.8 })
    cycle.hour = 6
    cycle.update(40)
    expect(cycle.hour).toBeCloseTo(12, 6)
    cycle.update(40)
    expect(cycle.hour).toBeCloseTo(18, 6)
    cycle.update(10)
    expect(cycle.hour).toBeCloseTo(0, 6)
    cycle.update(-10)
    expect(cycle.hour).toBeCloseTo(18, 6)
  })

  it('counts hours by the longitude', () => {
    const cycle = new DayCycle(new Atmosphere().place({ longitude: 90, latitude: 0 }), {
      date: noon
    })
    expect(cycle.hour).toBeCloseTo(18, 6)
    cycle.hour = 12
    expect(new Date(Math.round(cycle.time)).toISOString()).toBe('2026-06-21T06:00:00.000Z')
    const { y } = cycle.atmosphere.sunDirection
    expect((Math.asin(y) * 180) / Math.PI).toBeGreaterThan(66)
  })

  it('keeps the day if told to', () => {
    const cycle = new DayCycle(new Atmosphere(), { date: noon, rate: 86_400, holdDay: true })
    for (let i = 0; i < 49; i++) cycle.update(0.33)
    expect(new Date(cycle.time).toISOString().slice(0, 10)).toBe('2026-06-21')
    expect(cycle.hour).toBeCloseTo((12 + 24 * 49 * 0.33) % 24, 5)
  })

  it('has seasons: the sun of the solstices stands as high as the tropics say', () => {
    const atmosphere = new Atmosphere().place({ longitude: 0, latitude: 0 })
    const cycle = new DayCycle(atmosphere, { date: noon })
    cycle.latitude = 50
    const height = (season: number): number => {
      cycle.season = season
      cycle.hour = 12
      return (Math.asin(atmosphere.sunDirection.y) * 180) / Math.PI
    }
    for (const [season, declination] of [
      [0, 0],
      [0.2543, 23.44],
      [0.5106, 0],
      [0.7565, -23.44]
    ]) {
      // Its declination grows by 0.4° in the day that `season` rounds to.
      expect(Math.abs(height(season) - (40 + declination))).toBeLessThan(0.5)
      expect(Math.abs(((cycle.season - season + 1.5) % 1) - 0.5)).toBeLessThan(0.003)
    }
    expect(cycle.latitude).toBeCloseTo(50, 9)
  })

  it('takes exposure along without a jump, and keeps it while the sun stands', () => {
    const atmosphere = new Atmosphere()
    const camera = new PerspectiveCamera()
    const cycle = new DayCycle(atmosphere, { date: noon, rate: 1440 })
    let last = NaN
    for (let frame = 0; frame < 60 * 30; frame++) {
      cycle.update(1 / 30, camera)
      const { exposure } = cycle
      expect(atmosphere.luminanceScale / 1e-4 / exposure).toBeCloseTo(1, 9)
      // In 0.2° of nautical twilight, which is a frame, the light falls by a fifth.
      if (frame > 0) expect(Math.abs(Math.log2(exposure / last))).toBeLessThan(0.3)
      last = exposure
    }
    expect(Math.abs(Math.log2(last))).toBeLessThan(1)
  })

  it('keeps the season that was set, whatever the hour', () => {
    const season = fc.oneof(number(0, 0.99999), fc.constantFrom(0, 0.9985, 0.9995, 0.9999))
    fc.assert(
      fc.property(season, number(0, 23.99), number(-180, 180), number(-40, 40), (...given) => {
        const [asked, hour, longitude, years] = given
        const atmosphere = new Atmosphere().place({ longitude, latitude: 50 })
        const date = new Date(noon.getTime() + years * 365 * DAY)
        const cycle = new DayCycle(atmosphere, { date })
        cycle.hour = hour
        cycle.season = asked
        expect(cycle.season).toBeCloseTo(asked, 9)
        expect(cycle.hour).toBeCloseTo(hour, 5)
        const { time } = cycle
        cycle.season = asked
        expect(cycle.time).toBe(time)
        cycle.hour = 0
        expect(cycle.season).toBeCloseTo(asked, 9)
        // Once more by time alone, to half a day.
        cycle.time = time
        const off = cycle.season - asked
        expect(Math.abs(off - Math.round(off)) * 365.2422).toBeLessThan(0.5001)
      }),
      { ...runs, numRuns: 200 }
    )
  })

  it('does not wander through the year as its season goes to and fro', () => {
    const cycle = new DayCycle(new Atmosphere(), { date: noon })
    cycle.season = 0.3
    const { time } = cycle
    for (let i = 0; i < 50; i++) cycle.season = (i * 0.377) % 1
    cycle.season = 0.3
    expect(cycle.time).toBe(time)
    cycle.season = 0
    expect(cycle.season).toBe(0)
    cycle.season = 0.9995
    expect(cycle.season).toBeCloseTo(0.9995, 9)
  })

  it('takes over from another cycle at night', () => {
    const atmosphere = new Atmosphere()
    atmosphere.luminanceScale = 3e-4
    const camera = new PerspectiveCamera()
    const date = new Date('2026-06-21T00:00:00Z')
    const first = new DayCycle(atmosphere, { date })
    first.update(0, camera)
    const atNight = atmosphere.luminanceScale
    expect(atNight).toBeGreaterThan(1)
    const second = new DayCycle(atmosphere, { date })
    second.update(0, camera)
    expect(atmosphere.luminanceScale).toBe(atNight)
    second.hour = 12
    const third = new DayCycle(atmosphere)
    third.update(0, camera)
    expect(atmosphere.luminanceScale / 3e-4).toBeCloseTo(third.exposure, 9)
    expect(third.exposure).toBeLessThan(2)
    // One that was set by hand is daylight's.
    atmosphere.luminanceScale = 1e-3
    const fourth = new DayCycle(atmosphere)
    fourth.update(0, camera)
    expect(atmosphere.luminanceScale / 1e-3).toBeCloseTo(fourth.exposure, 9)
  })

  it('sets the latitude of places alone', () => {
    const atmosphere = new Atmosphere().place({ longitude: 90, latitude: 20, height: 300 })
    atmosphere.metersPerUnit = 1000
    const cycle = new DayCycle(atmosphere, { date: noon })
    cycle.latitude = -35
    const place = new Atmosphere().place({ longitude: 90, latitude: -35, height: 300 })
    place.metersPerUnit = 1000
    const pairs = atmosphere.worldToECEF.elements.map((v, i) => [v, place.worldToECEF.elements[i]])
    for (const [got, expected] of pairs) expect(Math.abs(got - expected)).toBeLessThan(1e-6)
    for (const latitude of [90, -90, 0, 48.2]) {
      cycle.latitude = latitude
      expect(cycle.latitude).toBeCloseTo(latitude, 9)
    }
    const byHand = atmosphere.worldToECEF.setPosition(7e6, 0, 0).clone()
    expect(() => (cycle.latitude = 10)).toThrow('DayCycle: frame must be of place()')
    expect(atmosphere.worldToECEF).toEqual(byHand)
    atmosphere.frame = 'ecef'
    expect(() => (cycle.latitude = 10)).toThrow("DayCycle: frame must be 'local'")
    expect(atmosphere.frame).toBe('ecef')
  })

  it('wants sensible numbers', () => {
    const atmosphere = new Atmosphere()
    const make = (options: object) => () => new DayCycle(atmosphere, options)
    expect(make({ daylight: 1 })).toThrow('DayCycle: daylight must be in (0, 1), got 1')
    expect(make({ rate: NaN })).toThrow('DayCycle: rate must be finite, got NaN')
    expect(make({ adaptation: -1 })).toThrow('DayCycle: adaptation must be finite and ≥ 0, got -1')
    expect(make({ date: new Date(NaN) })).toThrow('DayCycle: date must be a valid Date')
    expect(() => new DayCycle({} as Atmosphere)).toThrow('DayCycle: atmosphere must be')
    expect(() => new DayCycle(atmosphere).update(NaN)).toThrow('deltaSeconds must be finite')
  })
})

describe('exposure', () => {
  const camera = new PerspectiveCamera()

  it('falls with illuminance, from a moonless night to daylight', () => {
    let last = Infinity
    for (let exponent = -6; exponent < 6; exponent += 0.01) {
      const exposure = exposureOfIlluminance(10 ** exponent)
      expect(exposure).toBeLessThan(last)
      // What is brighter stays brighter in the picture.
      expect(exposure * 10 ** (exponent + 0.01)).toBeGreaterThan(
        exposureOfIlluminance(10 ** (exponent - 0.01)) * 10 ** exponent
      )
      last = exposure
    }
    expect(exposureOfIlluminance(1e5)).toBe(1)
    expect(exposureOfIlluminance(0)).toBeLessThan(Infinity)
  })

  const earth = new Atmosphere()
  const solved = new Atmosphere()
  solved.tables.data = solvedLight()

  it.each([
    ['with tables', solved],
    ['without tables', earth]
  ])('follows the sun without a jump, %s', (_, atmosphere) => {
    let last = NaN
    for (let elevation = 90; elevation >= -90; elevation -= 0.05) {
      atmosphere.setSunAngles(elevation, 100)
      const exposure = exposureFor(atmosphere, camera)
      // 0.05° of twilight are a fifth of a minute, in which the light falls by 4 %.
      if (elevation < 90) {
        expect(exposure).toBeGreaterThan(last * 0.999)
        expect(exposure / last).toBeLessThan(1.09)
      }
      last = exposure
    }
    expect(last).toBeGreaterThan(1e6)
    expect(last).toBeLessThan(1.1e6)
  })

  it('is within a stop of the same with and without tables', () => {
    for (let elevation = 60; elevation >= -18; elevation -= 1) {
      const [a, b] = [earth, solved].map(atmosphere =>
        exposureFor(atmosphere.setSunAngles(elevation, 30), camera)
      )
      expect(Math.abs(Math.log2(a / b)), `${elevation}°`).toBeLessThan(1)
    }
  })

  it('follows a camera from the ground to orbit and round the globe', () => {
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.sunDirection = new Vector3(1, 0, 0)
    let last = NaN
    for (let longitude = 0; longitude <= 180; longitude += 0.25) {
      Ellipsoid.WGS84.geodeticToECEF({ longitude, latitude: 0, height: 4e5 }, camera.position)
      camera.updateMatrixWorld()
      const exposure = exposureFor(atmosphere, camera)
      if (longitude > 0) expect(exposure / last).toBeGreaterThan(0.999)
      last = exposure
    }
    expect(last).toBeGreaterThan(1e6)
    for (let height = 1; height < 1e9; height *= 1.05) {
      Ellipsoid.WGS84.geodeticToECEF({ longitude: 180, latitude: 0, height }, camera.position)
      camera.updateMatrixWorld()
      const exposure = exposureFor(atmosphere, camera)
      expect(exposure).toBeLessThan(last * 1.001)
      expect(exposure).toBeGreaterThan(0)
      last = exposure
    }
  })

  it('wants light', () => {
    expect(() => exposureFor(earth, camera, { floor: 0 })).toThrow('floor must be positive')
  })
})
