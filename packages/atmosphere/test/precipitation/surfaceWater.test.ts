import { vec3 } from 'three/tsl'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { SurfaceWater, wetSurface } from '@welkin/atmosphere'
import {
  evaporation,
  saturationPressure,
  settledDensity,
  snowCoverFraction,
  snowmelt
} from '../../src/precipitation/cpu/surfaceWater'

/**
 * Evaporation by resistances [mm/h], in SI units: Penman–Monteith of a surface without stomata, with the aerodynamic resistance
 * that Thom & Oliver 1977, "On Penman's equation for estimating regional evaporation", read Penman's wind function as.
 */
function evaporationByResistance(
  temperature: number,
  humidity: number,
  wind: number,
  absorbed: number
): number {
  const pressure = 611.2 * Math.exp((17.62 * temperature) / (243.12 + temperature)) // Magnus [Pa]
  const slope = (pressure * 17.62 * 243.12) / (243.12 + temperature) ** 2
  const psychrometric = 66
  const resistance = (4.72 * Math.log(2 / 0.00137) ** 2) / (1 + 0.536 * wind)
  const heat = (1.2 * 1005 * pressure * (1 - humidity)) / resistance
  return ((slope * absorbed + heat) / (slope + psychrometric) / 2.48e6) * 3600
}

describe('evaporation', () => {
  it('is that by aerodynamic resistance', () => {
    fc.assert(
      fc.property(
        fc.double({ min: -5, max: 40, noNaN: true }),
        fc.double({ min: 0.1, max: 0.95, noNaN: true }),
        fc.double({ min: 0, max: 15, noNaN: true }),
        fc.double({ min: 0, max: 1000, noNaN: true }),
        (temperature, humidity, wind, absorbed) => {
          const expected = evaporationByResistance(temperature, humidity, wind, absorbed)
          const actual = evaporation(temperature, humidity, wind, absorbed)
          expect(Math.abs(actual / expected - 1)).toBeLessThan(0.08)
        }
      )
    )
  })

  it('has the pressure of vapour that tables have, and none in saturated air at night', () => {
    // Allen et al. 1998 (FAO 56), table 2.3 [kPa].
    expect(saturationPressure(20)).toBeCloseTo(2.338, 2)
    expect(saturationPressure(35)).toBeCloseTo(5.624, 2)
    expect(evaporation(15, 1, 5, 0)).toBe(0)
  })
})

describe('snow', () => {
  it('melts above 1 °C, with sun more', () => {
    expect(snowmelt(1, 800)).toBe(0)
    expect(snowmelt(5, 0)).toBeCloseTo(0.25, 10)
    expect(snowmelt(5, 500)).toBeCloseTo(0.25 + 0.94, 10)
  })

  it('settles towards 300 kg/m³, in one step as in many', () => {
    let density = 100
    for (let i = 0; i < 24; i++) density = settledDensity(density, 1)
    expect(density).toBeCloseTo(settledDensity(100, 24), 9)
    expect(settledDensity(100, 1e4)).toBeCloseTo(300, 6)
  })

  it('covers three quarters of the ground at 25 mm of depth when new, less when settled', () => {
    expect(snowCoverFraction(2.5, 100)).toBeCloseTo(Math.tanh(1), 10)
    expect(snowCoverFraction(2.5, 200)).toBeLessThan(snowCoverFraction(2.5, 100))
  })
})

describe('SurfaceWater', () => {
  it('gets wet, puddles, overflows, and dries', () => {
    const water = new SurfaceWater()
    water.update(60, { rain: 6, humidity: 1 })
    expect(water.water).toBeCloseTo(0.1, 6)
    expect(water.wetness).toBeCloseTo(0.2 ** (2 / 3), 6)
    expect(water.puddles).toBe(0)
    water.update(3600, { rain: 12, humidity: 1 })
    expect([water.wetness, water.puddles, water.water]).toEqual([1, 1, 2.5])
    expect(water.ringRate).toBeGreaterThan(10)
    const sunny = { temperature: 25, humidity: 0.4, wind: 4, irradiance: 800 }
    water.update(3600, sunny)
    // While puddles stand, the whole surface evaporates.
    const lost = evaporationByResistance(25, 0.4, 4, 720)
    expect((2.5 - water.water) / lost).toBeGreaterThan(0.92)
    expect((2.5 - water.water) / lost).toBeLessThan(1.08)
    expect(water.update(4 * 3600, sunny).wetness).toBe(0)
    expect(water.ringRate).toBe(0)
  })

  it('dries later without sun and wind', () => {
    const left = (wind: number, irradiance: number): number => {
      const water = new SurfaceWater()
      water.water = 2
      return water.update(3600, { temperature: 10, wind, irradiance }).water
    }
    expect(left(5, 0)).toBeLessThan(left(1, 0))
    expect(left(1, 400)).toBeLessThan(left(1, 0))
  })

  it('is white after hours of snow, and gives its water back when it melts', () => {
    const water = new SurfaceWater({ puddleCapacity: 50 })
    water.update(4 * 3600, { snow: 2, temperature: -3, humidity: 1 })
    expect(water.snow).toBeCloseTo(8, 9)
    expect(water.snowCover).toBeGreaterThan(0.95)
    expect(water.snowDepth).toBeGreaterThan(0.07)
    expect(water.snowDepth).toBeLessThan(0.08)
    expect(water.wetness).toBe(0)
    water.update(40 * 3600, { temperature: 5, humidity: 1 })
    expect([water.snow, water.snowCover]).toEqual([0, 0])
    expect(water.water).toBeCloseTo(8, 9)
  })

  it('gives shaders what it gives as numbers', () => {
    const water = new SurfaceWater().update(1800, { rain: 4, snow: 1, temperature: 0.5 })
    expect(water.wetnessNode.value).toBe(water.wetness)
    expect(water.puddlesNode.value).toBe(water.puddles)
    expect(water.snowCoverNode.value).toBe(water.snowCover)
    expect(water.snowCover).toBeGreaterThan(0)
    water.filmCapacity = 10
    expect(water.wetnessNode.value).toBe(water.wetness)
  })

  it('refuses what is wrong, and stays as it is', () => {
    const water = new SurfaceWater()
    expect(() => new SurfaceWater({ filmCapacity: 0 })).toThrow('SurfaceWater: filmCapacity')
    expect(() => new SurfaceWater({ depth: 1 } as never)).toThrow('SurfaceWater')
    expect(() => water.update(-1)).toThrow('SurfaceWater: seconds')
    expect(() => water.update(1, { rain: NaN })).toThrow('SurfaceWater: rain')
    expect(() => water.update(1, { hail: 3 } as never)).toThrow('SurfaceWater.weather')
    expect(() => (water.snow = -1)).toThrow('SurfaceWater: snow')
    expect(() => wetSurface({} as never)).toThrow('wetSurface: water')
    expect(() => wetSurface(water, { color: 1 as never })).toThrow('wetSurface: color')
    expect(Object.keys(wetSurface(water, { color: vec3(0.3) }))).toHaveLength(3)
    expect(water.water).toBe(0)
  })
})
