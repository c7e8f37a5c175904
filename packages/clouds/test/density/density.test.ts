import { Quaternion, Vector3 } from 'three'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { CloudLayer, type CloudLayerParameters } from '../../src/layers/CloudLayer'
import { cloudPreset, type CloudPresetName } from '../../src'
import { cloudExtinction, weatherAt, type CloudState } from '../twins/density'
import { NoiseTextures } from '../twins/noiseTextures'
import { layerRotation } from '../../src/density/lattice'
import {
  layerForms,
  layerPeriods,
  REGION_CELLS,
  weatherScales
} from '../../src/layers/layerUniforms'
import { windRotation } from '../../src/layers/wind'

const noise = new NoiseTextures()
const bottomRadius = 6_360_000
const stateOf = (parameters: Partial<CloudLayerParameters>): CloudState => ({
  layers: [new CloudLayer(parameters).parameters],
  rotations: [layerRotation(0)],
  bottomRadius,
  pixelAngle: 0.001
})

/** Random places at an altitude. */
const direction = fc
  .tuple(fc.double({ min: -1, max: 1, noNaN: true }), fc.double({ min: 0, max: 6.28, noNaN: true }))
  .map(([z, angle]) => {
    const across = Math.sqrt(1 - z * z)
    return new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
  })
const at = (up: Vector3, altitude: number): Vector3 => up.clone().setLength(bottomRadius + altitude)

describe('cloudExtinction', () => {
  it('is between 0 and the layer’s density, and 0 outside of its altitudes', () => {
    const state = stateOf({ coverage: 0.6 })
    fc.assert(
      fc.property(direction, fc.double({ min: 0, max: 3000, noNaN: true }), (up, altitude) => {
        const extinction = cloudExtinction(state, noise, at(up, altitude), 100, true)
        expect(extinction).toBeGreaterThanOrEqual(0)
        expect(extinction).toBeLessThanOrEqual(0.05)
        if (altitude <= 1000 || altitude >= 2200) expect(extinction).toBe(0)
      }),
      { numRuns: 60 }
    )
  })

  it('is 0 everywhere at coverage 0, and nowhere in the middle of a slab at coverage 1', () => {
    const clear = stateOf({ coverage: 0 })
    const slab = stateOf({ coverage: 1, shapeAmount: 0, detailAmount: 0, profileExponent: 1 })
    fc.assert(
      fc.property(direction, up => {
        expect(cloudExtinction(clear, noise, at(up, 1500), 100, true)).toBe(0)
        expect(cloudExtinction(slab, noise, at(up, 1600), 100, true)).toBeGreaterThan(0.02)
      }),
      { numRuns: 40 }
    )
  })

  it('grows with coverage', () => {
    const states = [0.2, 0.5, 0.8].map(coverage => stateOf({ coverage }))
    fc.assert(
      fc.property(direction, up => {
        const values = states.map(s => cloudExtinction(s, noise, at(up, 1300), 100, false))
        expect(values).toEqual(values.toSorted((a, b) => a - b))
      }),
      { numRuns: 40 }
    )
  })

  it('covers what is asked for, all over the planet', () => {
    const count = 600
    // A spiral of even density.
    const directions = Array.from({ length: count }, (_, i) => {
      const z = (2 * i + 1) / count - 1
      const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
      return new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
    })
    for (const coverage of [0.25, 0.6]) {
      const state = stateOf({ coverage })
      const covers = directions.map(
        up => weatherAt(state, noise, 0, at(up, 0), 100).filteredCoverage
      )
      const mean = covers.reduce((a, b) => a + b) / count
      // Systems are few: their number scatters.
      expect(Math.abs(mean - coverage), `${mean} for ${coverage}`).toBeLessThan(0.06)
    }
  })
})

describe('windTurn', () => {
  it('carries clouds with the wind', () => {
    const wind = { east: 12, north: -5 }
    const up = new Vector3(0.5, -0.6, 0.4).normalize()
    const east = new Vector3(-up.y, up.x, 0).normalize()
    const north = up.clone().cross(east)
    const before = stateOf({ coverage: 0.6 })
    const altitude = 1300
    const after: CloudState = {
      ...before,
      rotations: [
        layerRotation(0).multiply(
          windRotation(wind, up, 600, bottomRadius + altitude, new Quaternion())
        )
      ]
    }
    let cloudy = 0
    for (let i = 0; i < 40; i++) {
      const start = at(up, altitude).addScaledVector(east, 170 * i - 3000)
      start.setLength(bottomRadius + altitude)
      const end = start
        .clone()
        .addScaledVector(east, 600 * 12)
        .addScaledVector(north, 600 * -5)
      end.setLength(bottomRadius + altitude)
      const expected = cloudExtinction(before, noise, start, 100, false)
      const got = cloudExtinction(after, noise, end, 100, false)
      // Beside the camera the shell's turn is not quite the same shift: up to some metres.
      expect(Math.abs(got - expected)).toBeLessThan(0.02)
      if (expected > 0) cloudy++
    }
    expect(cloudy).toBeGreaterThan(5)
  })

  it('has a direction at the poles, and stands still in calm', () => {
    const turn = new Quaternion()
    windRotation({ east: 3, north: 4 }, new Vector3(0, 0, 1), 1000, bottomRadius, turn)
    expect(turn.toArray().every(Number.isFinite)).toBe(true)
    expect(turn.angleTo(new Quaternion())).toBeCloseTo(5000 / bottomRadius, 9)
    windRotation({ east: 0, north: 0 }, new Vector3(1, 0, 0), 1000, bottomRadius, turn)
    expect(turn.angleTo(new Quaternion())).toBe(0)
  })
})

describe('layer uniforms', () => {
  it('give the weather a variance of 1, whatever the weights, with and without a map', () => {
    const weight = fc.double({ min: 0, max: 1, noNaN: true })
    fc.assert(
      fc.property(fc.tuple(weight, weight, weight, weight), fc.boolean(), (weights, hasMap) => {
        fc.pre(Math.hypot(...weights) > 1e-3)
        const scales = weatherScales(weights, hasMap)
        // By channels, since scales are independent of each other.
        const clouds = scales.clouds.reduce((sum, w) => sum + w ** 2, 0) / 12
        const fields =
          scales.clouds.reduce(
            (sum, w, i) => sum + (scales.fields * w + (i === 2 ? scales.cells : 0)) ** 2,
            0
          ) / 12
        const regions = (scales.regions ** 2 * (1 + REGION_CELLS ** 2)) / 12
        expect(clouds).toBeCloseTo(scales.cloudVariance)
        expect(fields).toBeCloseTo(scales.fieldVariance)
        expect(clouds + fields + regions + scales.planet ** 2).toBeCloseTo(1)
        expect(hasMap ? regions + scales.planet : 0).toBe(0)
      })
    )
    expect(weatherScales([0, 0, 0, 0], false).clouds).toEqual([0, 0, 0, 0])
  })

  it('draw out cirrus alone, and spread the tops of tall towers alone', () => {
    const forms = (name: CloudPresetName) => layerForms(cloudPreset(name).at(0).parameters)
    expect(forms('cirrus').stretch).toBeGreaterThan(5)
    expect(forms('cirrus').sharpness).toBeLessThan(forms('fairWeather').sharpness)
    expect(forms('cumulonimbus').anvil).toBe(1)
    for (const name of ['fairWeather', 'stratocumulus', 'overcast'] as const) {
      expect(forms(name)).toMatchObject({ stretch: 1, anvil: 0, coarseness: 0 })
    }
  })

  it('make tall clouds broad', () => {
    const [low, tall] = [2200, 11_000].map(
      topAltitude => layerPeriods(new CloudLayer({ topAltitude }).parameters).weather
    )
    expect(tall / low).toBe(2)
  })
})

describe('cloudPreset', () => {
  it('knows six skies, each its own', () => {
    const names: CloudPresetName[] = [
      'fairWeather',
      'stratocumulus',
      'overcast',
      'cumulonimbus',
      'cirrus',
      'mixed'
    ]
    for (const name of names) {
      cloudPreset(name).at(0).set({ coverage: 0.01 })
      expect(cloudPreset(name).at(0).parameters.coverage).not.toBe(0.01)
    }
    expect(() => cloudPreset('foggy' as never)).toThrow(
      /name must be 'fairWeather', .* got 'foggy'/
    )
  })
})
