import { Atmosphere } from '@welkin/atmosphere'
import fc from 'fast-check'
import { PerspectiveCamera } from 'three'
import { float, vec4 } from 'three/tsl'
import { describe, expect, it, test } from 'vitest'
import { CloudLayer, cloudPreset, clouds, precipitationShafts } from '../../src'
import { fallColumn, fallDepthOver } from '../../src/precipitation/cpu/fallColumn'
import { DIFFRACTED, fallFloor, fallForm, STRONGEST } from '../../src/precipitation/fallForm'
import { CloudCover, CloudLayers } from '../../src'
import { extinctionOf, lagOf, rateOf, streakOf } from '../twins/precipitation'

const rates = fc.double({ min: 0.1, max: 100, noNaN: true })

describe('precipitation of a layer', () => {
  test('is checked with the layer, and live', () => {
    const layer = new CloudLayer({ precipitation: { rate: 12 } })
    expect(layer.precipitation).toMatchObject({ rate: 12, share: 0.5, freezingLevel: 2300 })
    layer.precipitation = { rate: 3, virgaDepth: 800 }
    expect(layer.precipitation).toMatchObject({ rate: 3, virgaDepth: 800 })
    expect(() => (layer.precipitation = { rate: -1 })).toThrow(
      'CloudLayer.precipitation: rate must be in [0, 300], got -1'
    )
    expect(() => layer.set({ precipitation: { rate: 5, share: 0 } })).toThrow(/share must be/)
    expect(() => layer.set({ precipitation: { rte: 5 } as never })).toThrow(
      "CloudLayer.precipitation: unknown option 'rte', did you mean 'rate'?"
    )
    expect(layer.precipitation?.rate).toBe(3)
    layer.precipitation = { rate: 4 }
    expect(layer.precipitation).toMatchObject({ rate: 4, virgaDepth: 800 })
    layer.precipitation = null
    expect(layer.precipitation).toBe(null)
    layer.precipitation = { rate: 4 }
    expect(layer.precipitation).toMatchObject({ rate: 4, virgaDepth: 0 })
  })

  test('comes with the presets that have any, and needs drops that are some', () => {
    const rain = (name: 'shower' | 'nimbostratus' | 'snowShower' | 'overcast') =>
      cloudPreset(name).at(0).precipitation?.rate
    expect([rain('shower'), rain('nimbostratus'), rain('snowShower')]).toEqual([12, 3, 1.5])
    expect(rain('overcast')).toBe(undefined)
    const [storm] = cloudPreset('hailstorm')
    expect(storm.parameters).toMatchObject({ anvil: 1, precipitation: { rate: 30, hail: 0.4 } })
    const dry = cloudPreset('cumulonimbus')
    const bare = [vec4(0), float(0), new PerspectiveCamera(), new Atmosphere()] as const
    clouds(...bare, dry).dispose()
    dry.at(0).precipitation = { rate: 30 }
    expect(dry.at(0).parameters).toEqual(storm.parameters)
    expect(() => clouds(...bare, dry)).toThrow('precipitation must be precipitationShafts')
    expect(() => precipitationShafts({ drops: {} as never })).toThrow(
      'PrecipitationShafts: drops must be a ScatteringPhase or null'
    )
    const [color, depth] = [vec4(0), float(0)]
    expect(() =>
      clouds(color, depth, new PerspectiveCamera(), new Atmosphere(), cloudPreset('shower'))
    ).toThrow('CloudsNode: precipitation must be precipitationShafts(): it rains')
    expect(() => precipitationShafts({ rain: 1 } as never)).toThrow("unknown option 'rain'")
  })

  test('is asked for as soon as a layer begins to rain, too, and not before', () => {
    const layers = cloudPreset('fairWeather', 2)
    const bare = [vec4(0), float(0), new PerspectiveCamera(), new Atmosphere()] as const
    const node = clouds(...bare, layers)
    const shown = clouds(...bare, layers, { precipitation: precipitationShafts() })
    const draw = (each: typeof node) => () => each.updateBefore({ renderer: null } as never)
    expect(draw(node)).not.toThrow()
    layers.copy(cloudPreset('shower'))
    expect(draw(node)).toThrow('CloudsNode: precipitation must be precipitationShafts(): it rains')
    expect(draw(shown)).not.toThrow()
    layers.copy(cloudPreset('cumulonimbus'))
    expect(draw(node)).not.toThrow()
  })
})

describe('precipitation', () => {
  it('is as opaque as was measured', () => {
    // Atlas 1953: 0.33 R^0.64 per km, visibility 3.0 km over 1.4/km in rain of 10 mm/h.
    expect(1000 * extinctionOf(1, 0, 0)).toBeCloseTo(0.33, 3)
    expect(1000 * extinctionOf(10, 0, 0)).toBeCloseTo(1.44, 2)
    // ITU-R P.1817: 3.84 dB/km for wet snow of 1 mm/h.
    expect((1000 * extinctionOf(1, 1, 0) * 10) / Math.log(10)).toBeCloseTo(3.84, 2)
    // Marshall & Palmer 1948, drops twice as wide as they block: 0.365 R^0.63.
    fc.assert(
      fc.property(rates, rate => {
        const drops = 4.1 * rate ** -0.21
        const section = ((Math.PI / 4) * 8000 * 2) / drops ** 3
        const ratio = extinctionOf(rate, 0, 0) / (2 * section * 1e-6)
        expect(ratio).toBeGreaterThan(0.87)
        expect(ratio).toBeLessThan(0.96)
        expect(extinctionOf(0, 0, rate)).toBeLessThan(extinctionOf(rate, 0, 0) / 3)
      })
    )
  })

  it('has the rate asked for in the mean over all columns from which it falls', () => {
    let mean = 0
    for (let i = 0; i < 1000; i++) mean += rateOf(12, (i + 0.5) / 1000, 0, 0) / 1000
    expect(mean).toBeCloseTo(12, 3)
  })

  it('has the same rate with streaks of any contrast, sharp or blurred', () => {
    for (const amount of [0, 0.5, 1, 1.5, 2, 3])
      for (const lost of [0, 0.4, 1]) {
        // Billows have a normal distribution, near enough.
        let [mean, weights] = [0, 0]
        for (let z = -5; z <= 5; z += 0.01) {
          const weight = Math.exp((-z * z) / 2)
          mean += weight * streakOf(z, amount, lost)
          weights += weight
        }
        expect(Math.abs(mean / weights - 1)).toBeLessThan(0.01)
      }
    expect(streakOf(1, 2, 0) / streakOf(-1, 2, 0)).toBeGreaterThan(8)
    expect(streakOf(3, 0, 0)).toBe(1)
    expect(streakOf(9, 3, 0)).toBe(STRONGEST)
  })

  it('falls in a parabola, the flatter the slower', () => {
    const { groundWind, hailSpeed, rainSpeed, snowSpeed } = fallForm
    const whole = (10 * (1 - groundWind) * 1000) / 2
    expect(lagOf(10, 0, 1000, 3000)).toBeCloseTo(whole / rainSpeed, 3)
    expect(lagOf(10, 0, 1000, -100)).toBeCloseTo(whole / snowSpeed, 3)
    expect(lagOf(10, 500, 1000, 3000)).toBeCloseTo(whole / 4 / rainSpeed, 3)
    expect(lagOf(10, 0, 1000, 3000, hailSpeed)).toBeCloseTo(whole / hailSpeed, 3)
  })

  it('leaves nothing below its floor, of the strongest streaks under the strongest column', () => {
    expect(fallFloor(2000, 0)).toBe(-Infinity)
    fc.assert(
      fc.property(rates, fc.double({ min: 50, max: 5000, noNaN: true }), (rate, virgaDepth) => {
        const depth = 3000 - fallFloor(3000, virgaDepth)
        // Rates go with the square of the rank.
        const rank = Math.sqrt(STRONGEST)
        expect(rateOf(rate, rank, 1.005 * depth, virgaDepth)).toBeLessThan(1e-6 * rate)
        expect(rateOf(rate, rank, 0.98 * depth, virgaDepth)).toBeGreaterThan(0)
      })
    )
  })

  it('evaporates: that of the given rate within the depth, heavier rain later', () => {
    expect(rateOf(5, Math.sqrt(1 / 3), 995, 1000)).toBeLessThan(0.001)
    expect(rateOf(5, 1, 1000, 1000)).toBeGreaterThan(1)
    expect(rateOf(5, 1, 1600, 1000)).toBeLessThan(0.01)
    fc.assert(
      fc.property(rates, fc.double({ min: 0, max: 1, noNaN: true }), (rate, rank) => {
        const [lower, higher] = [300, 200].map(depth => rateOf(rate, rank, depth, 1000))
        expect(lower).toBeLessThanOrEqual(higher + 1e-6)
      }),
      { numRuns: 20 }
    )
  })
})

describe('what falls, in the light of the sky', () => {
  const layer = { baseAltitude: 1200, topAltitude: 4200, coverage: 1, density: 1e-4 }
  const under = (precipitation: object, altitude: number): number => {
    const { parameters } = new CloudLayer({
      ...layer,
      precipitation: { rate: 6, ...precipitation }
    })
    return fallDepthOver(fallColumn(parameters)!, altitude)
  }

  it('is as deep as its extinction along the way, of drops or flakes that evaporate', () => {
    const { onset, melting } = fallForm
    const ceiling = layer.baseAltitude + 3000 * onset
    for (const [virgaDepth, freezingLevel] of [
      [0, 9000],
      [0, -900],
      [600, 9000],
      [0, 700]
    ]) {
      // By ranks and by heights, from the equation of what evaporates, in steps.
      let sum = 0
      for (let i = 0; i < 40; i++)
        for (let k = 0; k < 60; k++) {
          const altitude = ((k + 0.5) / 60) * ceiling
          const depth = Math.max(layer.baseAltitude - altitude, 0)
          const begun = Math.min((ceiling - altitude) / (ceiling - layer.baseAltitude), 1)
          const rate = begun * rateOf(6, (i + 0.5) / 40, depth, virgaDepth)
          const melted = Math.min(Math.max((altitude - freezingLevel) / melting + 1, 0), 1)
          sum += extinctionOf(rate, melted ** 2 * (3 - 2 * melted), 0)
        }
      const expected = (1 - DIFFRACTED) * (sum / 40 / 60) * ceiling
      expect(under({ virgaDepth, freezingLevel }, 0) / expected).toBeCloseTo(1, 1.5)
    }
  })

  it('grows on the way down, from none at the ceiling', () => {
    let last = 0
    expect(under({}, 1400)).toBe(0)
    for (let altitude = 1380; altitude >= 0; altitude -= 20) {
      const depth = under({}, altitude)
      expect(depth).toBeGreaterThanOrEqual(last)
      last = depth
    }
    expect(last).toBeGreaterThan(0.3)
  })

  it('takes light from the ground as Beer and its share say, and none from above it', () => {
    const covers = [null, { rate: 6, share: 0.4 }].map(
      precipitation => new CloudCover(new CloudLayers([{ ...layer, precipitation }]))
    )
    const beam = (altitude: number): number => {
      const [dry, wet] = covers.map(cover => cover.beam({ altitude, cosLight: 0.5 }))
      return wet / dry
    }
    expect(beam(0)).toBeCloseTo(0.6 + 0.4 * Math.exp(-under({}, 0) / 0.5), 3)
    expect(beam(0)).toBeLessThan(0.9)
    expect(beam(1500)).toBe(1)
  })
})
