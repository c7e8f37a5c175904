import {
  Atmosphere,
  AtmosphereParameters,
  exposureFor,
  exposureOfIlluminance,
  moon,
  moonIlluminanceAt,
  NIGHT_ILLUMINANCE,
  skyIlluminanceAt,
  sunIlluminanceAt,
  type Triple
} from '@welkin/atmosphere'
import fc from 'fast-check'
import { PerspectiveCamera, Vector3 } from 'three'
import { describe, expect, it } from 'vitest'
import { CloudCover, CloudLayers, CloudLightTable, cloudPreset } from '@welkin/clouds'
import { solvedLight } from '../../../atmosphere/test/solvedLight'
import { scalePhase } from '../../src/light/cpu/cloudPhase'

const up = new Vector3(0, 1, 0)
const luminance = ([r, g, b]: Triple): number => 0.2126 * r + 0.7152 * g + 0.0722 * b
const at = (altitude: number): Vector3 => new Vector3(0, altitude, 0)

const parameters = new AtmosphereParameters()
const atmosphere = new Atmosphere({ parameters })
atmosphere.tables.data = solvedLight()

/** Illuminance of level ground by sun, sky and clouds [lx]. */
function levelIlluminance(altitude: number, clouds: CloudCover | null = null): number {
  const sine = Math.max(atmosphere.sunDirection.y, 0)
  const sun = luminance(sunIlluminanceAt(atmosphere, at(altitude), { clouds }))
  return sine * sun + luminance(skyIlluminanceAt(atmosphere, at(altitude), up, { clouds }))
}

/** Level light without air: one wavelength. */
const airless = (cosLight: number, albedo: number, altitude = 0) => ({
  position: at(altitude),
  altitude,
  cosLight,
  groundAlbedo: [albedo],
  direct: () => [cosLight],
  diffuse: () => ({ up: [0], down: [albedo * cosLight] })
})

const deck = (coverage: number, density = 0.02): CloudLayers =>
  new CloudLayers([{ baseAltitude: 1000, topAltitude: 2000, coverage, density }])

describe('CloudCover', () => {
  it('has the light of an overcast over reflecting ground, by the closed form of both', () => {
    const cosines = fc.double({ min: 0.1, max: 1, noNaN: true })
    const albedos = fc.double({ min: 0, max: 0.9, noNaN: true })
    const densities = fc.double({ min: 1e-4, max: 0.005, noNaN: true })
    const light = new CloudLightTable({ forwardAsymmetry: 0.85, forwardShare: 0.9 })
    const g = scalePhase(light.phase).moments[1]
    fc.assert(
      fc.property(cosines, albedos, densities, (mu, albedo, density) => {
        const cover = new CloudCover(deck(1, density), { light })
        const place = airless(mu, albedo)
        const beam = cover.beam(place)
        const depth = -mu * Math.log(beam)
        // King & Harshvardhan 1986, Eddington, conservative: collimated and diffuse light.
        const denominator = 4 + 3 * (1 - g) * depth
        const transmittance = (2 + 3 * mu + (2 - 3 * mu) * beam) / denominator
        const spherical = 4 / denominator
        const ground = (mu * transmittance) / (1 - albedo * (1 - spherical))
        const [sky] = cover.irradiance(place, 1, [0])
        expect(sky + mu * beam).toBeCloseTo(ground, 4)
        // What faces down has the ground's light, and no other.
        const [below] = cover.irradiance(place, -1, [albedo * mu])
        expect(below).toBeCloseTo(albedo * ground, 4)
      }),
      { numRuns: 50 }
    )
  })

  it('is clear bit by bit where nothing covers or nothing casts shadows', () => {
    atmosphere.setSunAngles(35, 70)
    const clear = skyIlluminanceAt(atmosphere, at(2), up)
    const sun = sunIlluminanceAt(atmosphere, at(2))
    for (const layer of [{ coverage: 0 }, { coverage: 1, shadow: false }]) {
      const clouds = new CloudCover(new CloudLayers([layer]))
      expect(skyIlluminanceAt(atmosphere, at(2), up, { clouds })).toEqual(clear)
      expect(sunIlluminanceAt(atmosphere, at(2), { clouds })).toEqual(sun)
    }
    expect(skyIlluminanceAt(atmosphere, at(2), up, { clouds: null })).toEqual(clear)
    expect(skyIlluminanceAt(atmosphere, at(2), up, { source: atmosphere.sun })).toEqual(clear)
  })

  it.each([60, 25, 4])('takes more light the more they cover, with the sun %s° up', elevation => {
    atmosphere.setSunAngles(elevation, 70)
    const lights = Array.from({ length: 21 }, (_, i) =>
      levelIlluminance(2, new CloudCover(deck(i / 20)))
    )
    for (let i = 1; i < lights.length; i++) expect(lights[i]).toBeLessThan(lights[i - 1])
    expect(lights[0]).toBe(levelIlluminance(2))

    const overcast = levelIlluminance(2, new CloudCover(cloudPreset('overcast'))) / lights[0]
    expect(overcast).toBeGreaterThan(0.1)
    expect(overcast).toBeLessThan(0.4)
  })

  it('dims nothing above the clouds, and steadily more on the way down through them', () => {
    atmosphere.setSunAngles(40, 70)
    const clouds = new CloudCover(deck(0.9))
    for (const altitude of [2000, 2500, 12_000, 400_000]) {
      const ratio = levelIlluminance(altitude, clouds) / levelIlluminance(altitude)
      expect(ratio).toBeCloseTo(1, 9)
    }
    let last = levelIlluminance(2000, clouds)
    for (let altitude = 1980; altitude >= 1000; altitude -= 20) {
      const light = levelIlluminance(altitude, clouds)
      expect(light).toBeLessThan(last)
      expect(light).toBeGreaterThan(0.9 * last)
      last = light
    }
    // Without a step at the base, and with a little more from the ground below it.
    expect(levelIlluminance(999.9, clouds) / last).toBeCloseTo(1, 4)
    const atGround = levelIlluminance(2, clouds) / last
    expect(atGround).toBeGreaterThan(1)
    expect(atGround).toBeLessThan(1.06)
    // Their white lights what faces down.
    const below = [null, clouds].map(given =>
      luminance(skyIlluminanceAt(atmosphere, at(3000), at(-1), { clouds: given }))
    )
    expect(below[1]).toBeGreaterThan(2 * below[0])
  })

  it('passes a moon’s light as the sun’s', () => {
    const luna = moon().attach(atmosphere)
    luna.set({ direction: new Vector3(0.6, 0.8, 0), phase: 0.5 })
    const clouds = new CloudCover(deck(0.6))
    const options = { source: luna.source, clouds }
    atmosphere.sunDirection = new Vector3(0.6, 0.8, 0)
    const [bare, dimmed] = [undefined, { clouds }].map(given =>
      luminance(moonIlluminanceAt(luna, at(2), given))
    )
    const sun = luminance(sunIlluminanceAt(atmosphere, at(2), { clouds }))
    const clear = luminance(sunIlluminanceAt(atmosphere, at(2)))
    expect(dimmed / bare).toBeCloseTo(sun / clear, 9)
    const sky = (options: object): number =>
      luminance(skyIlluminanceAt(atmosphere, at(2), up, options))
    const ratio = sky(options) / sky({ source: luna.source })
    // Moonlight is a little redder.
    expect(ratio / (sky({ clouds }) / sky({}))).toBeCloseTo(1, 1)
  })
})

describe('exposureFor under clouds', () => {
  const camera = new PerspectiveCamera()
  const overcast = new CloudCover(cloudPreset('overcast'))
  const exposure = (altitude: number, clouds: CloudCover | null, options = {}): number => {
    camera.position.y = altitude
    camera.updateMatrixWorld()
    return exposureFor(atmosphere, camera, { clouds, ...options })
  }

  it.each([70, 30, 8])('is that of the light there, with the sun %s° up', elevation => {
    atmosphere.setSunAngles(elevation, 0)
    for (const clouds of [overcast, new CloudCover(deck(0.4)), null]) {
      const expected = exposureOfIlluminance(levelIlluminance(0, clouds))
      expect(exposure(0, clouds) / expected).toBeCloseTo(1, 2)
    }
  })

  it('does not change from above the clouds, nor where there are none', () => {
    for (const elevation of [50, 0, -7, -40]) {
      atmosphere.setSunAngles(elevation, 0)
      for (const altitude of [1500, 9000, 400_000]) {
        expect(exposure(altitude, overcast) / exposure(altitude, null)).toBeCloseTo(1, 9)
      }
      const none = new CloudCover(new CloudLayers([{ coverage: 0 }]))
      expect(exposure(2, none)).toBe(exposure(2, null))
    }
  })

  it('dims the night sky, but no illuminance that was given', () => {
    atmosphere.setSunAngles(-60, 0)
    const [albedo] = parameters.groundAlbedo
    const [transmitted] = overcast.irradiance(
      { ...airless(1, albedo), direct: () => [0], diffuse: () => ({ up: [1], down: [albedo] }) },
      1,
      [1]
    )
    expect(transmitted).toBeLessThan(0.5)
    const night = exposureOfIlluminance(NIGHT_ILLUMINANCE * transmitted)
    expect(exposure(2, overcast) / night).toBeCloseTo(1, 2)
    expect(exposure(2, overcast)).toBeGreaterThan(1.3 * exposure(2, null))
    expect(exposure(2, overcast, { floor: 3 }) / exposureOfIlluminance(3)).toBeCloseTo(1, 6)
  })

  it('follows the sun without a jump, and is within a stop of that before there are tables', () => {
    const early = new Atmosphere({ parameters })
    let last = NaN
    for (let elevation = 80; elevation >= -30; elevation -= 0.25) {
      atmosphere.setSunAngles(elevation, 0)
      early.setSunAngles(elevation, 0)
      const now = exposure(2, overcast)
      if (elevation < 80) {
        expect(now).toBeGreaterThan(0.99 * last)
        expect(now).toBeLessThan(1.4 * last)
      }
      const guess = exposureFor(early, camera, { clouds: overcast })
      if (elevation > -18) expect(Math.abs(Math.log2(guess / now)), `${elevation}°`).toBeLessThan(1)
      last = now
    }
  })
})
