import {
  Atmosphere,
  AtmosphereParameters,
  airlessParameters,
  marsParameters,
  planetGround,
  titanParameters,
  venusParameters,
  sunIlluminanceAt
} from '@welkin/atmosphere'
import { Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { spectralToLinearSRGB } from '../../src/air/cpu/color'
import { groundRadiance, skyRadiance } from '../../src/scattering/cpu/scattering'
import { solveDiffuseLight } from '../../src/diffuseLight/cpu/solveDiffuseLight'
import { DIFFUSE_SIZE, DIFFUSE_TILES } from '../../src/tables/tableSizes'
import { lightTransmittance } from '../../src/transmittance/cpu/transmittance'
import { QUICK } from '../solvedLight'

/** Part of the light of a sun at the zenith that arrives at the ground. */
const transmittanceTo = (parameters: AtmosphereParameters): number[] =>
  lightTransmittance(parameters, parameters.bottomRadius + 1, 1)

/** Linear sRGB of the sky 2 m above the ground, by angles in degrees. */
function skyColors(parameters: AtmosphereParameters) {
  const light = solveDiffuseLight(parameters, QUICK)
  const cos = (degrees: number): number => Math.cos((degrees * Math.PI) / 180)
  const sin = (degrees: number): number => Math.sin((degrees * Math.PI) / 180)
  return (elevation: number, azimuth: number, sunElevation: number): number[] => {
    const cosViewLight =
      sin(elevation) * sin(sunElevation) + cos(elevation) * cos(sunElevation) * cos(azimuth)
    const ray = {
      radius: parameters.bottomRadius + 2,
      cosView: sin(elevation),
      cosLight: sin(sunElevation),
      cosViewLight
    }
    const values = skyRadiance(parameters, light, ray)
    return spectralToLinearSRGB(
      parameters,
      values.map((value, i) => value * parameters.solarIrradiance[i]) as never
    )
  }
}

describe('planets', () => {
  it('has a butterscotch sky on Mars by day, and a blue glow at the setting sun', () => {
    const color = skyColors(marsParameters())
    for (const azimuth of [30, 90, 180]) {
      const [red, green, blue] = color(30, azimuth, 50)
      expect(red).toBeGreaterThan(1.15 * green)
      expect(green).toBeGreaterThan(1.25 * blue)
    }
    const blueness = ([red, , blue]: number[]): number => blue / red
    const glow = blueness(color(6, 0, 3))
    expect(glow).toBeGreaterThan(1)
    expect(glow).toBeGreaterThan(1.5 * blueness(color(6, 90, 3)))
  })

  it("gives Mars the sun's light of its distance", () => {
    const mars = marsParameters()
    const earth = new AtmosphereParameters()
    expect(mars.solarIrradiance[1] / earth.solarIrradiance[1]).toBeCloseTo(0.4307, 3)
    // 21 arc-minutes across.
    expect((2 * mars.sunAngularRadius * 180 * 60) / Math.PI).toBeCloseTo(21.1, 1)
  })

  it('lets as much light through as its optical depths say', () => {
    // Dust of depth 0.5 at 630 nm; gas of 610 Pa adds little.
    expect(-Math.log(transmittanceTo(marsParameters({ dust: 0.5 }))[3])).toBeCloseTo(0.5, 1)
    expect(-Math.log(transmittanceTo(marsParameters({ dust: 2 }))[3])).toBeCloseTo(2, 1)
    expect(-Math.log(transmittanceTo(titanParameters())[1])).toBeCloseTo(8.96 + 1.23, 0)
    expect(-Math.log(transmittanceTo(venusParameters())[1])).toBeCloseTo(3, 1)
  })

  it('has an orange sky on Titan', () => {
    const [red, green, blue] = skyColors(titanParameters())(40, 90, 50)
    expect(red).toBeGreaterThan(1.5 * green)
    expect(green).toBeGreaterThan(1.5 * blue)
  })

  it('shows a black sky and sunlit ground without air', () => {
    const moon = airlessParameters()
    expect(moon.isAirless).toBe(true)
    expect(marsParameters({ dust: 0 }).isAirless).toBe(false)
    // Light of its air, of which there is none: ground has sunlight alone.
    const [columns, rows] = DIFFUSE_SIZE
    const light = { values: new Float32Array(4 * columns * rows * DIFFUSE_TILES) }
    const ray = { radius: moon.bottomRadius + 2, cosView: 0.3, cosLight: 0.5, cosViewLight: 0.6 }
    expect(skyRadiance(moon, light, ray)).toEqual([0, 0, 0, 0])
    groundRadiance(moon, light, 0.5).forEach((value, i) => {
      expect(value).toBeCloseTo((0.5 * moon.groundAlbedo[i]) / Math.PI, 10)
    })
  })

  it.each([
    [() => marsParameters({ dust: -1 }), /dust must be in \[0, 10\], got -1/],
    [() => airlessParameters({ distance: 0 }), /distance must be in .*got 0/],
    [() => airlessParameters({ radius: NaN }), /airlessParameters: radius .*NaN/],
    [() => planetGround({ windSpeed: 99 }), /PlanetGround: windSpeed must be in \[0, 40\], got 99/],
    [() => planetGround({ roughness: NaN }), /PlanetGround: roughness .*NaN/]
  ])('refuses numbers that make no sense: %s', (make, message) => {
    expect(make).toThrow(message)
  })
})

describe('a flat world', () => {
  it('has the same light wherever one goes, and that of an atmosphere at its origin', () => {
    const flat = new Atmosphere({ flat: true }).place({ longitude: 10, latitude: 40 })
    const round = new Atmosphere().place({ longitude: 10, latitude: 40 })
    for (const atmosphere of [flat, round]) atmosphere.setSunAngles(4, 130)
    const here = sunIlluminanceAt(round, new Vector3(0, 500, 0))
    for (const [x, z] of [
      [0, 0],
      [1e5, -3e5],
      [-4e6, 1e7]
    ]) {
      const there = sunIlluminanceAt(flat, new Vector3(x, 500, z))
      there.forEach((value, i) => expect(value).toBeCloseTo(here[i], 6))
    }
    const far = sunIlluminanceAt(round, new Vector3(1e5, 500, -3e5))
    expect(Math.abs(far[0] / here[0] - 1)).toBeGreaterThan(0.1)
  })
  it('has no ECEF frame', () => {
    const atmosphere = new Atmosphere({ flat: true })
    expect(() => (atmosphere.frame = 'ecef')).toThrow("Atmosphere: frame must be 'local'")
    atmosphere.flat = false
    atmosphere.frame = 'ecef'
    expect(() => (atmosphere.flat = true)).toThrow('Atmosphere: flat must be false')
    expect(() => new Atmosphere({ flat: 1 as never })).toThrow('Atmosphere: flat must be true')
  })
})
