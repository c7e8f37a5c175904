import { Body, DefineStar, Equator, Horizon, Observer } from 'astronomy-engine'
import fc from 'fast-check'
import { Matrix4, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  Atmosphere,
  AtmosphereParameters,
  brightStars,
  proceduralStars,
  Stars,
  type Star
} from '@welkin/atmosphere'
import { eciToECEF, siderealAngle } from '@welkin/geo'
import { spectralToLinearSRGB } from '../../src/air/cpu/color'
import {
  COLOR_STEPS,
  ENTRY_COLUMNS,
  MAGNITUDE_RANGE,
  packStar,
  STAR_LEVELS,
  starCells,
  starDirection
} from '../../src/stars/starCells'
import { BYTES_PER_STAR, decodeStar, encodeStar } from '../../src/stars/starEncoding'
import { luminanceOf } from '../../src/parameters/photometry'
import { colorTemperature, starIrradiance } from '../../src/stars/starBrightness'
import { number, runs } from '../arbitraries'

const degrees = Math.PI / 180
const arcMinutes = degrees / 60
const catalogue = brightStars()

/**
 * Stars of the Hipparcos catalogue (ESA SP-1200): right ascension [h, m, s] and declination [°, ′, ″] of J2000,
 * proper motion in both [mas/a], V.
 */
const PUBLISHED = {
  Sirius: [6, 45, 8.917, -16, 42, 58.02, -546.01, -1223.08, -1.44],
  Canopus: [6, 23, 57.11, -52, 41, 44.4, 19.99, 23.67, -0.62],
  Arcturus: [14, 15, 39.672, 19, 10, 56.67, -1093.45, -1999.4, -0.05],
  'Alpha Centauri': [14, 39, 36.494, -60, 50, 2.37, -3678.19, 481.84, -0.01],
  Vega: [18, 36, 56.336, 38, 47, 1.28, 201.02, 287.46, 0.03],
  Capella: [5, 16, 41.359, 45, 59, 52.77, 75.52, -427.13, 0.08],
  Rigel: [5, 14, 32.272, -8, 12, 5.9, 1.87, -0.56, 0.18],
  Procyon: [7, 39, 18.119, 5, 13, 29.96, -716.57, -1034.58, 0.4],
  Betelgeuse: [5, 55, 10.305, 7, 24, 25.43, 27.33, 10.86, 0.45],
  Achernar: [1, 37, 42.845, -57, 14, 12.31, 88.02, -40.08, 0.45],
  Altair: [19, 50, 46.999, 8, 52, 5.96, 536.82, 385.54, 0.76],
  Acrux: [12, 26, 35.896, -63, 5, 56.73, -35.37, -14.73, 0.77],
  Aldebaran: [4, 35, 55.239, 16, 30, 33.49, 62.78, -189.36, 0.87],
  Spica: [13, 25, 11.579, -11, 9, 40.75, -42.5, -31.73, 0.98],
  Antares: [16, 29, 24.46, -26, 25, 55.21, -10.16, -23.21, 1.06],
  Deneb: [20, 41, 25.915, 45, 16, 49.22, 1.56, 1.55, 1.25],
  Polaris: [2, 31, 49.095, 89, 15, 50.79, 44.22, -11.74, 1.97]
} as const
type Published = (typeof PUBLISHED)[keyof typeof PUBLISHED]

/** Right ascension and declination of J2000 [°], moved to a date. */
function place(star: Published, date: Date): { ascension: number; declination: number } {
  const [h, m, s, d, minutes, seconds, motionAscension, motionDeclination] = star
  const years = (date.getTime() - Date.UTC(2000, 0, 1, 12)) / (365.25 * 86_400_000)
  const declination = Math.sign(d) * (Math.abs(d) + minutes / 60 + seconds / 3600)
  const ascension = (h + m / 60 + s / 3600) * 15
  return {
    ascension: ascension + (motionAscension * years) / 3.6e6 / Math.cos(declination * degrees),
    declination: declination + (motionDeclination * years) / 3.6e6
  }
}

const directionOf = (star: Star): Vector3 => new Vector3(...starDirection(star))

function nearest(ascension: number, declination: number): Star {
  const at = directionOf({
    ascension: ascension * degrees,
    declination: declination * degrees,
    magnitude: 0,
    colorIndex: 0
  })
  const near = catalogue.filter(star => directionOf(star).angleTo(at) < 4 * arcMinutes)
  return near.toSorted((a, b) => a.magnitude - b.magnitude)[0]
}

describe('star catalogue', () => {
  it('has 5,044 stars to magnitude 6, the brightest first', () => {
    expect(catalogue).toHaveLength(5044)
    catalogue.forEach((star, i) => {
      expect(star.magnitude).toBeLessThanOrEqual(6.0001)
      expect(star.magnitude).toBeGreaterThanOrEqual(catalogue[Math.max(i - 1, 0)].magnitude)
    })
  })

  it('has the brightest stars with the magnitude that is published', () => {
    const epoch = new Date(Date.UTC(2000, 0, 1, 12))
    const off = Object.entries(PUBLISHED).map(([name, star]) => {
      const { ascension, declination } = place(star, epoch)
      return [name, Math.abs(nearest(ascension, declination).magnitude - star[8])] as const
    })
    expect(off.filter(([, magnitudes]) => !(magnitudes < 0.03))).toEqual([])
  })

  it('reads what was written', () => {
    fc.assert(
      fc.property(
        number(0, 2 * Math.PI),
        number(-Math.PI / 2, Math.PI / 2),
        number(-1.4, 6),
        number(-0.4, 3.3),
        (ascension, declination, magnitude, colorIndex) => {
          const bytes = new Uint8Array(2 * BYTES_PER_STAR)
          const star = { ascension, declination, magnitude, colorIndex }
          encodeStar(star, bytes, 1)
          const back = decodeStar(bytes, 1)
          expect(directionOf(back).angleTo(directionOf(star)) / arcMinutes).toBeLessThan(0.012)
          expect(Math.abs(back.magnitude - magnitude)).toBeLessThanOrEqual(0.0151)
          expect(Math.abs(back.colorIndex - colorIndex)).toBeLessThanOrEqual(0.0076)
        }
      ),
      runs
    )
  })
})

describe('star positions', () => {
  const atmosphere = new Atmosphere()
  const world = new Matrix4()

  /** Altitude and azimuth [°] of a star of the catalogue, as drawn. */
  function drawn(star: Star, date: Date): Vector3 {
    world.copy(atmosphere.worldToECEF).invert()
    return directionOf(star).transformDirection(eciToECEF(date)).transformDirection(world)
  }

  it('are within 2′ of those of an ephemeris, aberration and proper motion included', () => {
    let worst = 0
    for (const iso of ['2000-01-01T12:00:00Z', '2026-08-12T17:46:00Z', '2038-01-19T03:14:07Z']) {
      const date = new Date(iso)
      for (const [longitude, latitude] of [
        [139.77, 35.68],
        [-70.4, -24.63],
        [0, 51.4769],
        [18.96, 69.65]
      ]) {
        atmosphere.place({ longitude, latitude })
        const observer = new Observer(latitude, longitude, 0)
        for (const [name, published] of Object.entries(PUBLISHED)) {
          const { ascension, declination } = place(published, date)
          DefineStar(Body.Star1, ascension / 15, declination, 1e4)
          const { ra, dec } = Equator(Body.Star1, date, observer, true, true)
          const { altitude, azimuth } = Horizon(date, observer, ra, dec)
          const [up, north] = [altitude * degrees, azimuth * degrees]
          const level = Math.cos(up)
          const expected = new Vector3(
            level * Math.sin(north),
            Math.sin(up),
            -level * Math.cos(north)
          )
          const j2000 = place(published, new Date(Date.UTC(2000, 0, 1, 12)))
          const off = drawn(nearest(j2000.ascension, j2000.declination), date).angleTo(expected)
          worst = Math.max(worst, off)
          // 3.7″ a year: no other star of the first magnitude is half as fast.
          const limit = name === 'Alpha Centauri' && date.getUTCFullYear() > 2030 ? 3 : 2
          expect(off / arcMinutes, `${name} ${iso}`).toBeLessThan(limit)
        }
      }
    }
    expect(worst).toBeGreaterThan(0)
  })

  it('have the apparent place of θ Persei that Meeus computes', () => {
    // Astronomical Algorithms, 2nd ed., example 23.a: 2028 November 13.19 TD; ΔT is 69 to 75 s.
    const date = new Date(Date.UTC(2028, 10, 13) + 0.19 * 86_400_000 - 72_000)
    const [ascension, declination] = [41.5599646, 49.3484833]
    const star = catalogue.find(
      ({ ascension, declination }) =>
        Math.abs(ascension / degrees - 41.05) < 0.05 &&
        Math.abs(declination / degrees - 49.228) < 0.02
    )
    expect(star).toBeDefined()
    const { x, y, z } = directionOf(star as Star).transformDirection(eciToECEF(date))
    const found = Math.atan2(y, x) + siderealAngle(date)
    const apart = ((found / degrees - ascension + 540) % 360) - 180
    expect(Math.abs(apart) * Math.cos(declination * degrees) * 60).toBeLessThan(2)
    expect(Math.abs(Math.asin(z) / degrees - declination) * 60).toBeLessThan(2)
  })

  it('have Polaris as high as the place is north', () => {
    const polaris = nearest(37.9545, 89.2641)
    for (const latitude of [10, 40, 69.65]) {
      atmosphere.place({ longitude: -100, latitude })
      const altitudes = Array.from({ length: 24 }, (_, hour) => {
        const star = drawn(polaris, new Date(Date.UTC(2026, 3, 1, hour)))
        return Math.asin(star.y) / degrees
      })
      // In 2026 it circles the pole at a distance of 37.5′.
      expect(Math.max(...altitudes) - latitude).toBeLessThan(0.64)
      expect(Math.max(...altitudes) - latitude).toBeGreaterThan(0.6)
      expect(latitude - Math.min(...altitudes)).toBeLessThan(0.64)
    }
  })
})

describe('star colours', () => {
  const earth = new AtmosphereParameters()

  it('add up to the illuminance', () => {
    fc.assert(
      fc.property(number(-0.4, 2), number(0, 1), (colorIndex, illuminance) => {
        const values = starIrradiance(earth, colorIndex, illuminance)
        expect(luminanceOf(earth, values)).toBeCloseTo(illuminance, 9)
      }),
      runs
    )
  })

  it('run from blue to red', () => {
    const ratio = (colorIndex: number): number => {
      const values = starIrradiance(earth, colorIndex, 1)
      const spectrum = values.map((value, i) => value * earth.solarIrradiance[i])
      const [r, , b] = spectralToLinearSRGB(earth, spectrum as never)
      return b / r
    }
    const ratios = [-0.3, 0, 0.3, 0.65, 1, 1.5, 2].map(ratio)
    ratios.slice(1).forEach((value, i) => expect(value).toBeLessThan(ratios[i]))
    expect(ratios[0]).toBeGreaterThan(1.2)
    expect(ratios[6]).toBeLessThan(0.6)
  })

  it('give the sun its temperature', () => {
    expect(Math.abs(colorTemperature(0.65) - 5778)).toBeLessThan(100)
  })
})

describe('star cells', () => {
  const { cells, entries } = starCells(catalogue)
  const width = STAR_LEVELS[0].cells

  /** First entry and number of entries where a direction is on the map: octant by octant. */
  function listAt(v: Vector3, level: number): [number, number] {
    const { cells: size } = STAR_LEVELS[level]
    const [x, y, z] = v.toArray().map(Math.abs)
    const [a, b] = [x / (x + y + z), y / (x + y + z)]
    // The lower half mirrored in the diamond's edge x + y = 1.
    const [u, w] = v.z < 0 ? [1 - b, 1 - a] : [a, b]
    const [column, row] = [v.x < 0 ? -u : u, v.y < 0 ? -w : w].map(p =>
      Math.min(Math.floor(((p + 1) / 2) * size), size - 1)
    )
    const texel = (row + (level === 0 ? 0 : width)) * width + column
    return [cells[2 * texel], cells[2 * texel + 1]]
  }

  it.each(STAR_LEVELS.map((_, level) => level))(
    'of level %i list every star that can shine into them',
    level => {
      const packed = catalogue.map(star =>
        [...starDirection(star), packStar(star)].map(Math.fround)
      )
      expect(packed).toHaveLength(5044)
      fc.assert(
        fc.property(number(-1, 1), number(0, 2 * Math.PI), (z, angle) => {
          const across = Math.sqrt(1 - z * z)
          const v = new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
          const [first, count] = listAt(v, level)
          const listed = new Set(
            Array.from({ length: count }, (_, i) =>
              entries.slice(4 * (first + i), 4 * (first + i) + 4).join()
            )
          )
          const missing = catalogue.filter(
            (star, i) =>
              directionOf(star).angleTo(v) < STAR_LEVELS[level].margin &&
              !listed.has(packed[i].join())
          )
          expect(missing).toEqual([])
        }),
        { ...runs, numRuns: 200 }
      )
    }
  )

  it('are few and short enough to look through for every pixel', () => {
    STAR_LEVELS.forEach(({ cells: size }, level) => {
      const counts = Array.from({ length: size * size }, (_, cell) => {
        const row = Math.floor(cell / size) + (level === 0 ? 0 : width)
        return cells[2 * (row * width + (cell % size)) + 1]
      })
      const mean = counts.reduce((sum, count) => sum + count, 0) / counts.length
      expect(mean).toBeLessThan([0.8, 6][level])
      expect(mean).toBeGreaterThan([0.4, 2][level])
      expect(Math.max(...counts)).toBeLessThan([16, 40][level])
    })
    expect(entries.length % (4 * ENTRY_COLUMNS)).toBe(0)
    expect(cells.byteLength + entries.byteLength).toBeLessThan(750_000)
  })

  it('keep magnitude and colour apart', () => {
    fc.assert(
      fc.property(number(-4, 20), number(-1, 3), (magnitude, colorIndex) => {
        const value = Math.fround(packStar({ ascension: 0, declination: 0, magnitude, colorIndex }))
        const step = Math.floor(value)
        const back = (value - step) * MAGNITUDE_RANGE.span + MAGNITUDE_RANGE.min
        expect(Math.abs(back - magnitude)).toBeLessThan(1e-3)
        const shown = COLOR_STEPS.min + step * COLOR_STEPS.step
        const last = COLOR_STEPS.min + (COLOR_STEPS.count - 1) * COLOR_STEPS.step
        const wanted = Math.min(Math.max(colorIndex, COLOR_STEPS.min), last)
        expect(Math.abs(shown - wanted)).toBeLessThan(0.0501)
      }),
      runs
    )
  })

  it('take no star that is not a number', () => {
    const star = { ascension: 0, declination: NaN, magnitude: 0, colorIndex: 0 }
    expect(() => new Stars({ catalogue: [star] })).toThrow(
      'Stars: declination of star 0 must be finite, got NaN'
    )
  })
})

describe('procedural stars', () => {
  const stars = proceduralStars({ seed: 7 })

  it('are the same for the same seed', () => {
    expect(proceduralStars({ seed: 7 })).toEqual(stars)
    expect(proceduralStars({ seed: 8 })).not.toEqual(stars)
  })

  it('are as many by magnitude as the real ones, within a third', () => {
    for (const magnitude of [3, 4, 5, 6]) {
      const count = (of: readonly Star[]): number =>
        of.filter(star => star.magnitude <= magnitude).length
      expect(count(stars) / count(catalogue)).toBeGreaterThan(2 / 3)
      expect(count(stars) / count(catalogue)).toBeLessThan(4 / 3)
    }
  })

  it('lie everywhere alike', () => {
    const sum = stars.reduce((total, star) => total.add(directionOf(star)), new Vector3())
    // √n steps at random: 0.014 of n; four times that has odds of one in thousands.
    expect(sum.length() / stars.length).toBeLessThan(0.05)
  })

  it('want sensible numbers', () => {
    expect(() => proceduralStars({ count: 0 })).toThrow(
      'count must be an integer in [1, 50000], got 0'
    )
    expect(() => proceduralStars({ faintest: NaN })).toThrow(
      'faintest must be in [-10, 20], got NaN'
    )
    expect(() => proceduralStars({ seed: Infinity })).toThrow('seed must be finite, got Infinity')
  })
})
