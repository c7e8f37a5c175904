import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { PerspectiveCamera, Vector3 } from 'three'
import {
  Atmosphere,
  DayCycle,
  Moon,
  moon,
  MoonDirectionalLight,
  moonIlluminanceAt,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import { SearchLocalSolarEclipse, Observer } from 'astronomy-engine'
import { Ellipsoid, moonPositionECEF } from '@welkin/geo'
import { sunObscuration } from '../../src/moon/cpu/eclipse'
import { moonIrradiance } from '../../src/moon/cpu/moonIrradiance'
import { lommelSeeligerPhase, moonPhaseLaw } from '../../src/moon/cpu/moonPhaseLaw'
import { number, runs } from '../arbitraries'

const degree = Math.PI / 180
const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b
const origin = new Vector3()

/** Allen 1976, Astrophysical Quantities, §66: phase angle [°] and magnitudes below the full moon. */
const ALLEN: readonly (readonly [number, number])[] = [
  [0, 0],
  [5, 0.08],
  [10, 0.23],
  [20, 0.51],
  [30, 0.79],
  [40, 1.06],
  [50, 1.35],
  [60, 1.62],
  [70, 1.91],
  [80, 2.24],
  [90, 2.63],
  [100, 3.04],
  [110, 3.48],
  [120, 3.93],
  [130, 4.44],
  [140, 5.07],
  [150, 5.9]
]

describe('version of a moon', () => {
  it('counts what is set by hand, a direction once it has moved by a tenth of a degree', () => {
    const luna = moon({ direction: new Vector3(1, 1, 0) }).attach(new Atmosphere())
    const counts = (change: () => void): number => {
      const { version } = luna
      change()
      return luna.version - version
    }
    expect(counts(() => (luna.direction = new Vector3(2, 2, 0)))).toBe(0)
    expect(
      counts(() => {
        for (let step = 1; step <= 25; step++) {
          const angle = (45 + 0.01 * step) * degree
          luna.direction = new Vector3(Math.cos(angle), Math.sin(angle), 0)
        }
      })
    ).toBe(2)
    expect(counts(() => (luna.direction = null))).toBe(1)
    expect(counts(() => (luna.direction = null))).toBe(0)
    expect(counts(() => (luna.phase = 0.25))).toBe(1)
    expect(counts(() => (luna.phase = 0.25))).toBe(0)
    for (const name of ['strength', 'earthshine', 'radius', 'distance'] as const) {
      expect(counts(() => (luna[name] = 3e8))).toBe(1)
      expect(counts(() => (luna[name] = 3e8))).toBe(0)
    }
  })
})

describe('moonlight', () => {
  it('has the illuminance of the published table at every phase angle, within 10 %', () => {
    // Magnitude 0 is 2.54e-6 lx above the air; the full moon −12.74. Allen 1976, §98, §66.
    const full = 2.54e-6 * 10 ** (0.4 * 12.74)
    const { solarIrradiance } = new Atmosphere().parameters
    const atmosphere = new Atmosphere()
    const luna = new Moon({ direction: new Vector3(0, 1, 0) }).attach(atmosphere)
    const high = new Vector3(0, 3e5, 0)
    expect(solarIrradiance.length).toBe(4)
    for (const [angle, magnitudes] of ALLEN) {
      luna.phase = 0.5 - angle / 360
      expect(luna.seenFrom(high).phaseAngle / degree).toBeCloseTo(angle, 3)
      const expected = full * 10 ** (-0.4 * magnitudes)
      const ratio = luminance(moonIlluminanceAt(luna, high)) / expected
      expect(Math.abs(ratio - 1), `${angle}°: ${ratio}`).toBeLessThan(0.1)
    }
  })

  it('is about a quarter of a lux on the ground under a high full moon', () => {
    const luna = new Moon({ direction: new Vector3(0, 1, 0), phase: 0.5 }).attach(new Atmosphere())
    const lux = luminance(moonIlluminanceAt(luna, origin))
    expect(lux).toBeGreaterThan(0.22)
    expect(lux).toBeLessThan(0.32)
  })

  it('falls without a jump to nothing when new', () => {
    fc.assert(
      fc.property(number(0, Math.PI - 0.01), angle => {
        const [here, there] = [moonPhaseLaw(angle), moonPhaseLaw(angle + 0.01)]
        expect(there).toBeLessThan(here)
        expect(there).toBeGreaterThan(here * 0.5 - 1e-5)
      }),
      runs
    )
    expect(moonPhaseLaw(0)).toBe(1)
    expect(moonPhaseLaw(Math.PI)).toBe(0)
  })

  it('is the sum of the disc that Lommel and Seeliger draw', () => {
    for (const angle of [0.01, 0.5, 1.5, 2.5, 3]) {
      let sum = 0
      const steps = 1500
      for (let i = 0; i < steps; i++) {
        for (let j = 0; j < steps; j++) {
          const [x, y] = [((i + 0.5) / steps) * 2 - 1, ((j + 0.5) / steps) * 2 - 1]
          const z = Math.sqrt(1 - x * x - y * y)
          const light = x * Math.sin(angle) + z * Math.cos(angle)
          if (z > 0 && light > 0) sum += light / (light + z)
        }
      }
      const mean = (sum * 4) / steps ** 2 / Math.PI
      expect(Math.abs(2 * mean - lommelSeeligerPhase(angle))).toBeLessThan(1e-3)
    }
  })

  it('grows with the square of size and nearness', () => {
    const [one, four] = [moonIrradiance(1, 4e8, 2e6), moonIrradiance(1, 2e8, 2e6)]
    expect(four[0] / one[0]).toBeCloseTo(4, 12)
    expect(moonIrradiance(1, 4e8, 4e6)[3] / one[3]).toBeCloseTo(4, 12)
  })
})

describe('Moon', () => {
  it('is where the date puts it, parallax included', () => {
    const date = new Date('2026-05-23T20:30:00Z')
    const place = { longitude: 10, latitude: 45 }
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.date = date
    const here = Ellipsoid.WGS84.geodeticToECEF(place)
    const expected = moonPositionECEF(date).sub(here)
    const seen = moon().attach(atmosphere).seenFrom(here)
    expect(seen.direction.angleTo(expected) / degree).toBeLessThan(10 / 3600)
    expect(seen.distance / expected.length()).toBeCloseTo(1, 12)
    // First quarter was at 11:11 UTC on that day.
    expect(Math.abs(seen.litFraction - 0.5)).toBeLessThan(0.05)
    atmosphere.place(place).date = date
    const local = moon().attach(atmosphere).seenFrom(origin)
    expect(local.phaseAngle).toBeCloseTo(seen.phaseAngle, 9)
  })

  it('stands opposite the sun and full without a date, or as far from it as its phase says', () => {
    const atmosphere = new Atmosphere().setSunAngles(-20, 250)
    const luna = new Moon().attach(atmosphere)
    const { direction, litFraction } = luna.seenFrom(origin)
    expect(direction.angleTo(atmosphere.sunDirection)).toBeCloseTo(Math.PI, 6)
    expect(litFraction).toBeCloseTo(1, 9)
    for (const [phase, lit] of [
      [0, 0],
      [0.25, 0.5],
      [0.75, 0.5],
      [1, 0]
    ]) {
      luna.phase = phase
      const seen = luna.seenFrom(origin)
      const elongation = Math.PI - Math.abs(2 * Math.PI * phase - Math.PI)
      expect(seen.direction.angleTo(atmosphere.sunDirection)).toBeCloseTo(elongation, 6)
      expect(seen.litFraction).toBeCloseTo(lit, 9)
    }
  })

  it('waxes and wanes as a day cycle runs, and exposure follows its light', () => {
    const atmosphere = new Atmosphere().place({ longitude: 0, latitude: 35 })
    const luna = moon().attach(atmosphere)
    const sources = [luna.source]
    // Almanac: new on 16 May 2026 at 20:01 UTC, quarters on 23 May at 11:11 and 8 June at 10:00,
    // full on 31 May at 08:45, new on 15 June at 02:54.
    const date = new Date('2026-05-16T20:01:00Z')
    const [lit, dark] = [{ sources }, {}].map(
      exposureOptions =>
        new DayCycle(atmosphere, { date, rate: 86_400, adaptation: 0, exposureOptions })
    )
    const camera = new PerspectiveCamera()
    const fractions = [0, 6.63, 7.9, 8.05, 6.7].map(days => {
      lit.update(days)
      return luna.seenFrom(origin).litFraction
    })
    const [first, quarter, full, last, next] = fractions
    for (const value of [first, next]) expect(value).toBeLessThan(0.005)
    for (const value of [quarter, last]) expect(Math.abs(value - 0.5)).toBeLessThan(0.03)
    expect(full).toBeGreaterThan(0.99)

    const midnight = Date.UTC(2026, 4, 31)
    const exposures = [lit, dark].map(cycle => {
      cycle.time = midnight
      cycle.update(0, camera)
      return cycle.exposure
    })
    expect(exposures[1] / exposures[0]).toBeGreaterThan(10)
    // A fortnight later there is no moon at midnight.
    lit.time = Date.UTC(2026, 5, 15)
    lit.update(0, camera)
    expect(lit.exposure / exposures[1]).toBeCloseTo(1, 2)
  })

  it('takes no wrong argument', () => {
    const atmosphere = new Atmosphere()
    expect(() => moon().attach(undefined as never)).toThrow('Moon.attach: atmosphere must be')
    expect(() => moon().source).toThrow('Moon: is in no atmosphere yet')
    expect(() => moon().seenFrom(origin)).toThrow('Moon: is in no atmosphere yet')
    expect(() => new Moon({ phase: 1.5 })).toThrow('Moon: phase must be')
    expect(() => new Moon({ distance: 0 })).toThrow('Moon: distance must be')
    expect(() => new Moon({ radius: NaN })).toThrow('Moon: radius must be')
    expect(() => new Moon({ strength: -1 })).toThrow('Moon: strength must be')
    expect(() => new Moon({ mapSize: 100 })).toThrow('Moon: mapSize must be')
    expect(() => new Moon({ direction: origin })).toThrow('Moon: direction must not be zero')
    expect(() => new Moon({ flare: { innerPower: 0 } })).toThrow('Moon: innerPower')
    expect(() => new MoonDirectionalLight(atmosphere, null as never)).toThrow('must be a Moon')
    const other = moon().attach(new Atmosphere())
    expect(() => new MoonDirectionalLight(atmosphere, other)).toThrow(
      'Moon.attach: atmosphere must be the one that it was added to before'
    )
    expect(() => atmosphere.add(other)).toThrow(
      'Moon.attach: atmosphere must be the one that it was added to before'
    )
  })
})

describe('eclipse', () => {
  it('covers what two plain circles share', () => {
    const circles = (s: number, m: number): number => {
      const a = Math.acos((s * s + 1 - m * m) / (2 * s))
      const b = Math.acos((s * s + m * m - 1) / (2 * s * m))
      const kite = Math.sqrt((1 + m - s) * (s + 1 - m) * (s - 1 + m) * (s + 1 + m)) / 2
      return (a + m * m * b - kite) / Math.PI
    }
    fc.assert(
      fc.property(number(0.5, 1.5), number(0.001, 0.999), (m, part) => {
        const s = Math.abs(1 - m) + part * (1 + m - Math.abs(1 - m))
        expect(Math.abs(sunObscuration(s * 3, 3, m * 3) - circles(s, m))).toBeLessThan(1e-4)
      }),
      runs
    )
  })

  it('covers all, or none, or grows as the discs come nearer', () => {
    expect(sunObscuration(0, 1, 1.05, 0.6)).toBeCloseTo(1, 9)
    expect(sunObscuration(2.1, 1, 1.05, 0.6)).toBe(0)
    expect(sunObscuration(0, 1, 0.95, 0)).toBeCloseTo(0.95 ** 2, 6)
    fc.assert(
      fc.property(number(0.5, 1.5), number(0, 2.6), number(0, 1), (m, s, u) => {
        const [near, far] = [sunObscuration(s, 1, m, u), sunObscuration(s + 0.01, 1, m, u)]
        expect(far).toBeLessThanOrEqual(near + 1e-6)
        expect(near).toBeGreaterThanOrEqual(0)
      }),
      runs
    )
  })

  const sunlight = (longitude: number, latitude: number, time: string): number => {
    const atmosphere = new Atmosphere().place({ longitude, latitude })
    atmosphere.date = new Date(time)
    const bare = luminance(sunIlluminanceAt(atmosphere, origin))
    atmosphere.add(moon())
    return luminance(sunIlluminanceAt(atmosphere, origin)) / bare
  }

  it('was total in Dallas from 18:40:43 to 18:44:33 on 2024-04-08', () => {
    const dallas = (time: string): number => sunlight(-96.797, 32.777, `2024-04-08T${time}Z`)
    for (const time of ['18:40:50', '18:42:38', '18:44:25']) {
      expect(dallas(time)).toBeLessThan(2e-6)
    }
    for (const time of ['18:40:30', '18:44:45']) {
      expect(dallas(time)).toBeGreaterThan(1e-5)
      expect(dallas(time)).toBeLessThan(0.02)
    }
    expect(dallas('17:20:00')).toBe(1)
    expect(dallas('20:10:00')).toBe(1)
  })

  it('has the obscuration that an almanac computes, anywhere', () => {
    for (const [latitude, longitude, start] of [
      [44.65, -63.57, '2025-03-01'],
      [40.71, -74, '2024-04-01'],
      [51.5, -0.12, '2026-08-01'],
      [42.34, -3.7, '2026-08-01'],
      [35, 139, '2030-05-01'],
      [-33.9, 151.2, '2028-07-01']
    ] as const) {
      const observer = new Observer(latitude, longitude, 0)
      const { peak, obscuration } = SearchLocalSolarEclipse(new Date(start), observer)
      const atmosphere = new Atmosphere().place({ longitude, latitude })
      atmosphere.date = peak.time.date
      const { direction, angularRadius } = moon().attach(atmosphere).seenFrom(origin)
      const apart = direction.angleTo(atmosphere.sunDirection)
      const covered = sunObscuration(apart, 0.004675, angularRadius)
      expect(Math.abs(covered - obscuration), `${latitude}, ${longitude}`).toBeLessThan(0.01)
    }
  })

  it('is partial in Halifax on 2025-03-29, 83 % at 10:17 UTC', () => {
    const atmosphere = new Atmosphere().place({ longitude: -63.57, latitude: 44.65 })
    atmosphere.add(moon())
    const left = (time: string): number => {
      atmosphere.date = new Date(`2025-03-29T${time}Z`)
      return atmosphere.sun.irradianceAt(origin)[2]
    }
    // The middle of the sun, which is brighter than the limb, is covered: more light is gone than area.
    expect(left('10:17:00')).toBeGreaterThan(0.12)
    expect(left('10:17:00')).toBeLessThan(0.17)
    expect(left('10:07:00')).toBeGreaterThan(left('10:17:00'))
    expect(left('10:27:00')).toBeGreaterThan(left('10:17:00'))
  })

  it('is none on other days, at full moon, or of a moon that was not added', () => {
    expect(sunlight(-96.8, 32.8, '2024-04-07T18:42:00Z')).toBe(1)
    expect(sunlight(-96.8, 32.8, '2024-04-23T18:42:00Z')).toBe(1)
    const atmosphere = new Atmosphere().place({ longitude: -96.8, latitude: 32.8 })
    atmosphere.date = new Date('2024-04-08T18:42:30Z')
    moon().attach(atmosphere)
    expect(luminance(sunIlluminanceAt(atmosphere, origin))).toBeGreaterThan(1e4)
  })

  it('ends when the moon is removed or disposed, but not when the atmosphere is disposed', () => {
    const atmosphere = new Atmosphere().place({ longitude: -96.8, latitude: 32.8 })
    atmosphere.date = new Date('2024-04-08T18:45:00Z')
    const left = (): number => luminance(sunIlluminanceAt(atmosphere, origin))
    const bare = left()
    const luna = moon().attach(atmosphere)
    const other = moon({ direction: new Vector3(0, 1, 0) }).attach(atmosphere)
    expect(left()).toBe(bare)
    atmosphere.add(luna, other)
    const dim = left()
    expect(dim / bare).toBeLessThan(0.03)
    expect(atmosphere.remove(luna).layers).toEqual([other])
    expect(left()).toBe(bare)
    atmosphere.add(luna).dispose()
    expect(atmosphere.layers).toEqual([other, luna])
    expect(left()).toBe(dim)
    luna.dispose()
    expect(atmosphere.layers).toEqual([other])
    expect(left()).toBe(bare)
    atmosphere.add(luna)
    expect(left()).toBe(dim)
  })

  it('leaves nothing behind of a thousand moons that came and went', () => {
    const atmosphere = new Atmosphere().place({ longitude: -96.8, latitude: 32.8 })
    atmosphere.date = new Date('2024-04-08T18:45:00Z')
    const luna = moon().attach(atmosphere)
    let asked = 0
    for (let i = 0; i < 1000; i++) {
      const guest = moon().attach(atmosphere)
      guest.eclipse = () => {
        asked++
        return [0, 0, 0, 0]
      }
      atmosphere.add(guest)
      atmosphere.remove(guest)
    }
    atmosphere.add(luna)
    expect(atmosphere.sun.irradianceAt(origin)).toEqual(luna.eclipse(origin))
    atmosphere.remove(luna)
    const milliseconds = ({ sun }: Atmosphere): number => {
      const start = performance.now()
      for (let i = 0; i < 20_000; i++) sun.irradianceAt(origin)
      return performance.now() - start
    }
    // No chain of a thousand functions, which would take hundreds of times as long.
    const fresh = milliseconds(new Atmosphere())
    expect(milliseconds(atmosphere)).toBeLessThan(50 * fresh + 100)
    expect(atmosphere.sun.irradianceAt(origin)).toEqual([1, 1, 1, 1])
    expect(asked).toBe(0)
  })
})
