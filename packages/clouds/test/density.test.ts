import { Quaternion, Vector3 } from 'three'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { CloudLayer, type CloudLayerParameters } from '../src/CloudLayer'
import { cloudPreset, type CloudPresetName } from '../src/index'
import { cloudExtinction, weatherAt, type CloudState } from '../src/cpu/density'
import { NoiseTextures } from '../src/cpu/noiseTextures'
import { layerTurn } from '../src/lattice'
import { layerPeriods, standardWeights, WEATHER_AGAIN } from '../src/layerUniforms'
import { windTurn } from '../src/wind'

const noise = new NoiseTextures()
const bottomRadius = 6_360_000
const stateOf = (parameters: Partial<CloudLayerParameters>): CloudState => ({
  layers: [new CloudLayer(parameters).parameters],
  turns: [layerTurn(0)],
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

  it('loses no cover with distance', () => {
    const state = stateOf({ coverage: 0.4 })
    const covers = Array.from({ length: 60 }, (_, i) => {
      const up = new Vector3(Math.cos(i), Math.sin(1.7 * i), Math.cos(2.3 * i + 1)).normalize()
      return weatherAt(state, noise, 0, at(up, 0), 2e7).cover
    })
    // Up to the regions' departures from the mean.
    expect(covers.reduce((a, b) => a + b) / covers.length).toBeCloseTo(0.4, 1)
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
      turns: [
        layerTurn(0).multiply(windTurn(wind, up, 600, bottomRadius + altitude, new Quaternion()))
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
    windTurn({ east: 3, north: 4 }, new Vector3(0, 0, 1), 1000, bottomRadius, turn)
    expect(turn.toArray().every(Number.isFinite)).toBe(true)
    expect(turn.angleTo(new Quaternion())).toBeCloseTo(5000 / bottomRadius, 9)
    windTurn({ east: 0, north: 0 }, new Vector3(1, 0, 0), 1000, bottomRadius, turn)
    expect(turn.angleTo(new Quaternion())).toBe(0)
  })
})

describe('layer uniforms', () => {
  it('keep the variance of the weather, whatever the weights', () => {
    const one = Math.hypot(...standardWeights([0.2, 0, 0, 0]))
    expect(Math.hypot(...standardWeights([0.2, 0.9, 0, 0.4]))).toBeCloseTo(one)
    const variance = (one ** 2 * (1 + WEATHER_AGAIN.weight ** 2)) / 12
    expect(variance).toBeCloseTo(1)
    expect(standardWeights([0, 0, 0, 0])).toEqual([0, 0, 0, 0])
  })

  it('make tall clouds broad', () => {
    const [low, tall] = [2200, 11_000].map(
      topAltitude => layerPeriods(new CloudLayer({ topAltitude }).parameters).weather
    )
    expect(tall / low).toBe(4)
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
    expect(() => cloudPreset('foggy' as never)).toThrow(/name must be one of .* got foggy/)
  })
})
