import { Quaternion, Vector3 } from 'three'
import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { CloudLayer, type CloudLayerParameters } from '../../src/layers/CloudLayer'
import { cloudPreset, cloudPresetNames, type CloudPresetName } from '../../src'
import { densityForm } from '../../src/density/formConstants'
import { cloudExtinction, sampleLayer, weatherAt, type CloudState } from '../twins/density'
import { NoiseTextures } from '../twins/noiseTextures'
import { layerRotation } from '../../src/density/lattice'
import {
  layerForms,
  layerPeriods,
  MESOSCALE_PER_REGIONS,
  REGION_SIZE,
  scaleWeights,
  weatherScales
} from '../../src/layers/layerUniforms'
import { neededStrength } from '../../src/layers/meanColumn'
import { windRotation } from '../../src/layers/wind'

const noise = new NoiseTextures()
const bottomRadius = 6_360_000
const stateOf = (parameters: Partial<CloudLayerParameters>): CloudState => ({
  layers: [new CloudLayer(parameters).parameters],
  rotations: [layerRotation(0)],
  bottomRadius,
  zenith: new Vector3(0.5, -0.6, 0.4).normalize(),
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
        expect(extinction).toBeLessThanOrEqual(0.1)
        if (altitude <= 1000 || altitude >= 2200) expect(extinction).toBe(0)
      }),
      { numRuns: 60 }
    )
  })

  it('is 0 everywhere at coverage 0, and nowhere in the middle of a slab at coverage 1', () => {
    const clear = stateOf({ coverage: 0 })
    const slab = stateOf({ coverage: 1, shapeAmount: 0, profileExponent: 1, densityGrowth: 0 })
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

  const count = 600
  /** A spiral of even density. */
  const directions = Array.from({ length: count }, (_, i) => {
    const z = (2 * i + 1) / count - 1
    const [across, angle] = [Math.sqrt(1 - z * z), 2.399963 * i]
    return new Vector3(across * Math.cos(angle), across * Math.sin(angle), z)
  })

  it('covers what is asked for, all over the planet', () => {
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

  it('gathers storms in the convergence zones, with few where air sinks', () => {
    const state = stateOf({ ...cloudPreset('cumulonimbus').at(0).parameters, shear: 0 })
    const areas = directions.map(
      up => weatherAt(state, noise, 0, at(up, 0), 100).storm!.radius ** 2
    )
    const meanOf = (from: number, to: number): number => {
      const own = areas.filter(
        (_, i) => from <= Math.abs(directions[i].z) && Math.abs(directions[i].z) < to
      )
      return own.reduce((a, b) => a + b) / own.length
    }
    // Sines of latitudes.
    const ratio = meanOf(0, 0.15) / meanOf(0.33, 0.5)
    expect(ratio, 'area of storms at the equator over the subtropics').toBeGreaterThan(5)
  })
})

/** A spot, and level displacements around it. */
const up = new Vector3(0.5, -0.6, 0.4).normalize()
const east = new Vector3(-up.y, up.x, 0).normalize()
const north = up.clone().cross(east)
const near = (toEast: number, toNorth: number, altitude: number): Vector3 =>
  at(up, 0)
    .addScaledVector(east, toEast)
    .addScaledVector(north, toNorth)
    .setLength(bottomRadius + altitude)

describe('windRotation', () => {
  it('carries clouds with the wind', () => {
    const wind = { east: 12, north: -5 }
    // Those that lean do so by the wind where the camera is.
    const before = stateOf({ coverage: 0.97, shear: 0 })
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
      const x = 170 * i - 3000
      const expected = cloudExtinction(before, noise, near(x, 0, altitude), 100, false)
      const end = near(x + 600 * 12, 600 * -5, altitude)
      const got = cloudExtinction(after, noise, end, 100, false)
      // Beside the camera the shell's turn is not quite the same shift: up to some metres.
      expect(Math.abs(got - expected)).toBeLessThan(0.04)
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

describe('shear', () => {
  /** Columns without billows, whose strength at a height is a copy of that at the base. */
  const plain = { coverage: 0.6, shapeAmount: 0, turbulence: 0, wind: { east: 3, north: -4 } }
  const strengthAt = (shear: number, toEast: number, toNorth: number, height: number): number => {
    const state = { ...stateOf({ ...plain, shear }), zenith: up }
    const place = near(toEast, toNorth, 1000 + 1200 * height)
    const { parameters } = new CloudLayer(plain)
    return (
      sampleLayer(state, noise, 0, place, 10, false).strength + neededStrength(parameters, height)
    )
  }

  it('makes columns lean downwind by its product with the height', () => {
    const places = Array.from({ length: 80 }, (_, i) => [400 * i - 8000, 170 * i] as const)
    for (const height of [0.5, 0.9]) {
      for (const shear of [0.2, -0.5]) {
        const lean = shear * height * 1200
        // Fields of clouds do not lean, and shift single ones a little: the lean is that of most alike columns.
        const apartAt = (share: number): number =>
          places.reduce((sum, [x, y]) => {
            const there = [x + 0.6 * share * lean, y - 0.8 * share * lean] as const
            return sum + Math.abs(strengthAt(shear, ...there, height) - strengthAt(shear, x, y, 0))
          }, 0)
        const shares = [-1, -0.5, 0, 0.5, 1, 1.5, 2]
        const apart = shares.map(apartAt)
        expect(shares[apart.indexOf(Math.min(...apart))]).toBe(1)
        for (const [x, y] of places) {
          expect(strengthAt(0, x, y, height)).toBeCloseTo(strengthAt(shear, x, y, 0), 6)
        }
      }
    }
  })

  it('does nothing in calm', () => {
    const calm = { coverage: 0.6, wind: { east: 0, north: 0 } }
    for (let i = 0; i < 10; i++) {
      const [still, sheared] = [0, 3].map(shear =>
        cloudExtinction(stateOf({ ...calm, shear }), noise, near(300 * i, 0, 1500), 10, true)
      )
      expect(sheared).toBe(still)
    }
  })
})

describe('openCells', () => {
  it('turns the cells of stratocumulus inside out', () => {
    const states = [0, 1].map(openCells => stateOf({ weatherWeights: [0, 1, 0, 0], openCells }))
    const sums = Array.from({ length: 60 }, (_, i) =>
      states.map(state => weatherAt(state, noise, 0, near(731 * i, 412 * i, 0), 10).sum)
    )
    // What is larger than fields is the same in both.
    const [closed, open] = [0, 1].map(k => sums.map(pair => pair[k] - (pair[0] + pair[1]) / 2))
    closed.forEach((value, i) => expect(open[i]).toBeCloseTo(-value, 9))
    expect(Math.max(...closed.map(Math.abs))).toBeGreaterThan(0.5)
  })

  it('keeps the variance from closed cells to open ones', () => {
    fc.assert(
      fc.property(fc.double({ min: 0, max: 1, noNaN: true }), openCells => {
        const size = (whole: number): number =>
          Math.hypot(...weatherScales([0.2, 1, 0.1, 0], false, whole).clouds)
        expect(size(openCells)).toBeCloseTo(size(0), 9)
      })
    )
    const signs = [0, 0.5, 1].map(whole =>
      Math.sign(weatherScales([0, 1, 0, 0], false, whole).clouds[1])
    )
    expect(signs).toEqual([1, 0, -1])
  })

  it('leaves other kinds of weather alone', () => {
    for (const weights of [
      [1, 0, 0, 0],
      [0, 0, 1, 0],
      [0, 0, 0, 1]
    ]) {
      const [closed, open] = [0, 1].map(whole => weatherScales(weights, false, whole))
      open.clouds.forEach((weight, i) => expect(weight).toBeCloseTo(closed.clouds[i], 12))
      expect({ ...open, clouds: [] }).toEqual({ ...closed, clouds: [] })
    }
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
        const regions = (scales.regions ** 2 * REGION_SIZE ** 2) / 12
        expect(clouds).toBeCloseTo(scales.cloudVariance)
        expect(fields).toBeCloseTo(scales.fieldVariance)
        const mesoscale =
          ((MESOSCALE_PER_REGIONS * scales.regions) ** 2 * (1 + scaleWeights.bands ** 2)) / 12
        expect(clouds + fields + mesoscale + regions + scales.planet ** 2).toBeCloseTo(1)
        expect(hasMap ? regions + scales.planet : 0).toBe(0)
      })
    )
    expect(weatherScales([0, 0, 0, 0], false).clouds).toEqual([0, 0, 0, 0])
  })

  it('keep that variance with open cells', () => {
    const share = fc.double({ min: 0, max: 1, noNaN: true })
    fc.assert(
      fc.property(share, share, (openCells, cumulus) => {
        const [closed, open] = [0, 1].map(whole => weatherScales([cumulus, 1, 0, 0], false, whole))
        expect(open.cloudVariance).toBe(closed.cloudVariance)
        expect(open.clouds[1]).toBe(-closed.clouds[1])
        const part = weatherScales([cumulus, 1, 0, 0], false, openCells)
        expect(Math.abs(part.clouds[1])).toBeLessThanOrEqual(closed.clouds[1])
      })
    )
  })

  it('draw out cirrus alone, and soften edges as they are told to', () => {
    const forms = (name: CloudPresetName) => layerForms(cloudPreset(name).at(0).parameters)
    expect(forms('cirrus').stretch).toBeGreaterThan(5)
    expect(forms('cirrus').edge).toBeGreaterThan(5 * forms('fairWeather').edge)
    expect(forms('cumulonimbus').coarseness).toBeGreaterThan(1)
    for (const name of ['fairWeather', 'congestus', 'stratocumulus', 'overcast'] as const) {
      expect(forms(name)).toMatchObject({ stretch: 1, coarseness: 0 })
    }
    const edges = [0, 0.5, 1].map(
      edgeSoftness => layerForms(new CloudLayer({ edgeSoftness }).parameters).edge
    )
    expect(edges[0]).toBe(densityForm.crispEdge)
    expect(edges[1]).toBeCloseTo(Math.sqrt(edges[0] * edges[2]))
    expect(edges[2]).toBeCloseTo(densityForm.crispEdge * densityForm.softEdge)
  })

  it('make tall clouds broad, and take factors of every size', () => {
    const periods = (parameters: Partial<CloudLayerParameters>) =>
      layerPeriods(new CloudLayer(parameters).parameters)
    const usual = periods({})
    expect(periods({ topAltitude: 11_000 }).weather / usual.weather).toBe(2)
    expect(periods({ topAltitude: 11_000 }).shape / usual.shape).toBe(4)
    expect(periods({ weatherScale: 3 })).toEqual({ ...usual, weather: 3 * usual.weather })
    // Detail is in proportion to billows.
    const broad = periods({ shapeScale: 2 })
    expect(broad).toEqual({ ...usual, shape: 2 * usual.shape, detail: 2 * usual.detail })
    expect(periods({ detailScale: 0.5 })).toEqual({ ...usual, detail: usual.detail / 2 })
    expect(usual.detail).toBeLessThan(usual.shape / 4)
  })

  it('leave the noise where it is when altitudes change a little', () => {
    for (const topAltitude of [2100, 2300, 2500]) {
      expect(layerPeriods(new CloudLayer({ topAltitude }).parameters)).toEqual(
        layerPeriods(new CloudLayer().parameters)
      )
    }
  })
})

describe('cloudPreset', () => {
  it('knows skies by name, each its own', () => {
    expect(cloudPresetNames).toEqual([
      'fairWeather',
      'congestus',
      'stratocumulus',
      'overcast',
      'cumulonimbus',
      'altocumulus',
      'cirrus',
      'mixed',
      'shower',
      'nimbostratus',
      'snowShower',
      'hailstorm',
      'fog'
    ])
    for (const name of cloudPresetNames) {
      cloudPreset(name).at(0).set({ coverage: 0.01 })
      expect(cloudPreset(name).at(0).parameters.coverage).not.toBe(0.01)
    }
    expect(() => cloudPreset('foggy' as never)).toThrow(
      /name must be 'fairWeather', .* got 'foggy'/
    )
  })
})
