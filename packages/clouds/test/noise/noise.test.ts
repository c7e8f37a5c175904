import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import { billow, channelNoise, curlNoise, hashCell, perlin, type Vec3Array } from '../twins/noise'
import { NoiseTextures } from '../twins/noiseTextures'
import { CURL_SCALE, shapeChannels, weatherChannels } from '../../src/noise/noiseRecipes'
import { NOISE_SIZE, type NoiseName } from '../../src/noise/noiseSizes'

const unit = fc.double({ min: 0, max: 1, noNaN: true })
const place = fc.tuple(unit, unit, unit)
const whole = fc.integer({ min: -3, max: 3 })
const turns = fc.tuple(whole, whole, whole)
const cells = fc.tuple(...[1, 2, 3].map(() => fc.integer({ min: 1, max: 24 })))
const moved = (p: Vec3Array, by: Vec3Array): Vec3Array => [p[0] + by[0], p[1] + by[1], p[2] + by[2]]

/** A grid of places that meets all of a texture. */
const grid = (edge: number): Vec3Array[] =>
  Array.from({ length: edge ** 3 }, (_, i) => [
    ((i % edge) + 0.37) / edge,
    ((Math.floor(i / edge) % edge) + 0.61) / edge,
    (Math.floor(i / edge ** 2) + 0.13) / edge
  ])

describe('hashCell', () => {
  it('spreads evenly, without relation between its numbers', () => {
    const count = 20_000
    const sums = { x: 0, xx: 0, xy: 0, next: 0 }
    for (let i = 0; i < count; i++) {
      const { x, y } = hashCell(i, 3, 5)
      sums.x += x / count
      sums.xx += (x - 0.5) ** 2 / count
      sums.xy += ((x - 0.5) * (y - 0.5)) / count
      sums.next += ((x - 0.5) * (hashCell(i + 1, 3, 5).x - 0.5)) / count
    }
    expect(sums.x).toBeCloseTo(0.5, 2)
    expect(sums.xx).toBeCloseTo(1 / 12, 2)
    expect(Math.abs(sums.xy)).toBeLessThan(0.003)
    expect(Math.abs(sums.next)).toBeLessThan(0.003)
  })
})

describe.for([
  ['perlin', perlin, -1.6, 1.6],
  ['billow', billow, 0, 1]
] as const)('%s', ([, noise, least, most]) => {
  it('tiles, and keeps to its range', () => {
    fc.assert(
      fc.property(place, turns, cells, (p, by, count) => {
        const value = noise(p, count as never, 7)
        expect(noise(moved(p, by), count as never, 7)).toBeCloseTo(value, 9)
        expect(value).toBeGreaterThanOrEqual(least)
        expect(value).toBeLessThanOrEqual(most)
      })
    )
  })

  it('is continuous, across its cells and its period', () => {
    fc.assert(
      fc.property(place, cells, (p, count) => {
        const step = 1e-7
        const change =
          noise(moved(p, [step, step, step]), count as never, 7) - noise(p, count as never, 7)
        expect(Math.abs(change)).toBeLessThan(40 * 24 * step)
      })
    )
  })
})

describe('channelNoise', () => {
  it('takes every weather equally often', () => {
    for (const [i, channel] of weatherChannels.entries()) {
      const values = grid(18)
        .map(p => channelNoise(channel, 3 + i, p))
        .toSorted((a, b) => a - b)
      for (const share of [0.1, 0.25, 0.5, 0.75, 0.9]) {
        const quantile = values[Math.floor(share * values.length)]
        expect(Math.abs(quantile - share), `channel ${i}, ${share}`).toBeLessThan(0.06)
      }
    }
  })

  it('gives shapes a mean of one half', () => {
    for (const [i, channel] of shapeChannels.entries()) {
      const values = grid(16).map(p => channelNoise(channel, i, p))
      expect(values.reduce((a, b) => a + b) / values.length).toBeCloseTo(0.5, 1)
      expect(Math.min(...values)).toBeGreaterThanOrEqual(0)
      expect(Math.max(...values)).toBeLessThanOrEqual(1)
    }
  })
})

describe('curlNoise', () => {
  it('has no sources and no sinks', () => {
    const step = 0.005
    let [divergence, gradient] = [0, 0]
    for (const p of grid(5)) {
      const slope = (axis: number, component: number): number => {
        const by = (sign: number): Vec3Array =>
          [0, 1, 2].map(i => (i === axis ? sign * step : 0)) as unknown as Vec3Array
        const ends = [1, -1].map(sign => curlNoise(moved(p, by(sign)))[component])
        return (ends[0] - ends[1]) / CURL_SCALE / step
      }
      divergence += (slope(0, 0) + slope(1, 1) + slope(2, 2)) ** 2
      gradient += slope(0, 0) ** 2 + slope(1, 1) ** 2 + slope(2, 2) ** 2
    }
    expect(divergence).toBeLessThan(0.01 * gradient)
  })
})

describe('NoiseTextures', () => {
  const textures = new NoiseTextures()

  it.for(Object.keys(NOISE_SIZE) as NoiseName[])('of %s tile without a seam', name => {
    const edge = 1 / NOISE_SIZE[name]
    for (const [x, y] of [
      [0.3, 0.7],
      [0.9, 0.2]
    ]) {
      const across = [-1, -0.5, 0, 0.5, 1].map(k => textures.sample(name, [k * edge, x, y], 0)[0])
      const steps = across.slice(1).map((v, i) => Math.abs(v - across[i]))
      const inside = [-1, -0.5, 0, 0.5, 1].map(
        k => textures.sample(name, [0.5 + k * edge, x, y], 0)[0]
      )
      const usual = inside.slice(1).map((v, i) => Math.abs(v - inside[i]))
      expect(Math.max(...steps)).toBeLessThan(4 * Math.max(...usual) + 0.1)
      expect(textures.sample(name, [x + 2, y - 1, 5], 0)).toEqual(
        textures.sample(name, [x, y, 0], 0).map(v => expect.closeTo(v, 9))
      )
    }
  })

  it('blur towards the mean', () => {
    const spread = (level: number): number => {
      const values = grid(4).map(p => textures.sample('detail', p, level)[0])
      const mean = values.reduce((a, b) => a + b) / values.length
      return values.reduce((sum, v) => sum + (v - mean) ** 2, 0)
    }
    expect(spread(3)).toBeLessThan(0.3 * spread(0))
  })
})
