import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import {
  Atmosphere,
  AtmosphereParameters,
  skyIlluminanceAt,
  standardEarthParameters,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import type { DiffuseLightData } from '../../src/diffuseLight/cpu/diffuseLight'
import { solveDiffuseLight } from '../../src/diffuseLight/cpu/solveDiffuseLight'
import { almanacIlluminance, NIGHT_ILLUMINANCE } from '../../src/night/cpu/twilight'
import { QUICK, solvedLight } from '../solvedLight'

const luminance = ([r, g, b]: readonly number[]): number => 0.2126 * r + 0.7152 * g + 0.0722 * b

describe('sunIlluminanceAt', () => {
  it('gives the same sunlight in every frame and unit', () => {
    const local = new Atmosphere().place({ longitude: 0, latitude: 45 })
    const global = new Atmosphere()
    global.frame = 'ecef'
    global.metersPerUnit = 1000
    local.date = global.date = new Date('2026-03-20T17:30:00Z')
    const here = new Vector3(100, 2000, -300)
    const there = here.clone().applyMatrix4(local.worldToECEF).divideScalar(1000)
    const [a, b] = [sunIlluminanceAt(local, here), sunIlluminanceAt(global, there)]
    a.forEach((value, i) => expect(b[i] / value).toBeCloseTo(1, 6))
    expect(a[0]).toBeGreaterThan(a[2])
  })

  it('has night on the far side and 132 klx above the air', () => {
    const atmosphere = new Atmosphere()
    atmosphere.frame = 'ecef'
    atmosphere.sunDirection = new Vector3(1, 0, 0)
    const [r, g, b] = sunIlluminanceAt(atmosphere, new Vector3(7e6, 0, 0))
    expect(0.2126 * r + 0.7152 * g + 0.0722 * b).toBeGreaterThan(129_000)
    expect(sunIlluminanceAt(atmosphere, new Vector3(-6.38e6, 0, 0))).toEqual([0, 0, 0])
  })
})

describe('twilight', () => {
  /** Light of sun and sky on level ground over the almanac's, by the sun's elevation [°]. */
  function overAlmanac(
    parameters: AtmosphereParameters,
    light: DiffuseLightData
  ): (elevation: number) => number {
    const atmosphere = new Atmosphere({ parameters })
    atmosphere.tables.data = light
    const [place, up] = [new Vector3(), new Vector3(0, 1, 0)]
    return elevation => {
      atmosphere.setSunAngles(elevation, 30)
      const sky = luminance(skyIlluminanceAt(atmosphere, place, up))
      const { y } = atmosphere.sunDirection
      const sun = y > 0 ? y * luminance(sunIlluminanceAt(atmosphere, place)) : 0
      return (sky + sun) / almanacIlluminance(elevation)
    }
  }

  it('and day are within 25 % of the almanac in the standard atmosphere, until the sun is 12° down', () => {
    const parameters = standardEarthParameters()
    const ratio = overAlmanac(parameters, solveDiffuseLight(parameters, QUICK))
    for (let elevation = 90; elevation >= -18; elevation--) {
      // Later in the evening the night sky has its share, which the almanac counts.
      const night = NIGHT_ILLUMINANCE / almanacIlluminance(elevation)
      const total = ratio(elevation) + night
      if (elevation >= -12) expect(Math.abs(total - 1), `${elevation}°`).toBeLessThan(0.25)
      else expect(Math.abs(Math.log2(total)), `${elevation}°`).toBeLessThan(1)
      if (elevation === -12) expect(night).toBeLessThan(0.12)
    }
  })

  it('is up to 1.9 times as bright in the default air, which has too many molecules high up', () => {
    // At 50 km exp(−h/8 km) is 2.3 times the density of the U.S. Standard Atmosphere. The bounds are
    // what the default has, with 10 % to spare.
    const ratio = overAlmanac(new AtmosphereParameters(), solvedLight())
    for (const [elevation, expected] of [
      [90, 0.95],
      [20, 1.33],
      [0, 1.37],
      [-4, 1.83],
      [-8, 1.38],
      [-10, 1.56],
      [-12, 1.22]
    ] as const) {
      expect(Math.abs(ratio(elevation) / expected - 1), `${elevation}°`).toBeLessThan(0.1)
    }
  })
})
