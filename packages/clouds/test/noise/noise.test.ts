import fc from 'fast-check'
import { describe, expect, it } from 'vitest'
import {
  billow,
  channelNoise,
  curl,
  curlNoise,
  hashBits,
  hashCell,
  perlin,
  potentials,
  type Vec3Array
} from '../twins/noise'
import { NoiseTextures } from '../twins/noiseTextures'
import {
  ENCODING_SCALE,
  FIRST_CHANNEL,
  detailChannel,
  noiseDeviations,
  seedOf,
  shapeChannels,
  weatherChannels
} from '../../src/noise/noiseRecipes'
import { NOISE_SIZE, type NoiseName } from '../../src/noise/noiseSizes'

const unit = fc.double({ min: 0, max: 1, noNaN: true })
const place = fc.tuple(unit, unit, unit)
const whole = fc.integer({ min: -3, max: 3 })
const periods = fc.tuple(whole, whole, whole)
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
      fc.property(place, periods, cells, (p, by, count) => {
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

describe('hashBits', () => {
  it('makes nine numbers of ten bits that are even and unrelated', () => {
    const count = 20_000
    const shares = Array.from({ length: 9 }, () => Array.from({ length: 9 }, () => 0))
    const means = Array.from({ length: 9 }, () => 0)
    for (let i = 0; i < count; i++) {
      const bits = hashBits(i % 27, Math.floor(i / 27) % 27, Math.floor(i / 729) + 400)
      const parts = [0, 1, 2].flatMap(word =>
        [22, 12, 2].map(shift => ((bits[word] >>> shift) & 1023) / 1023 - 0.5)
      )
      parts.forEach((x, a) => {
        means[a] += x / count
        parts.forEach((y, b) => (shares[a][b] += (12 * x * y) / count))
      })
    }
    for (let a = 0; a < 9; a++) {
      expect(Math.abs(means[a])).toBeLessThan(0.01)
      for (let b = 0; b < 9; b++) {
        expect(Math.abs(shares[a][b] - (a === b ? 1 : 0)), `${a} ${b}`).toBeLessThan(0.035)
      }
    }
  })
})

describe('billow', () => {
  it('is one less the distance to the nearest of many points', () => {
    fc.assert(
      fc.property(place, fc.integer({ min: 3, max: 9 }), (p, count) => {
        let nearest = 1
        const around = Array.from({ length: 3 * count }, (_, i) => i - count)
        const close = (axis: number): number[] =>
          around.filter(i => Math.abs(i + 0.5 - p[axis] * count) < 2.5)
        for (const i of close(0)) {
          for (const j of close(1)) {
            for (const k of close(2)) {
              const cell = [i, j, k].map(n => (n + count) % count)
              const { x, y, z } = hashCell(cell[0], cell[1], cell[2] + 7)
              const gap = [i + x, j + y, k + z].map((place, axis) => place - p[axis] * count)
              nearest = Math.min(nearest, Math.hypot(...gap))
            }
          }
        }
        expect(billow(p, [count, count, count], 7)).toBeCloseTo(1 - nearest, 9)
      })
    )
  })
})

describe('curl', () => {
  const counts = fc.integer({ min: 2, max: 16 })
  const along = (p: Vec3Array, axis: number, step: number): Vec3Array =>
    p.map((x, i) => (i === axis ? x + step : x)) as unknown as Vec3Array

  it('tiles, and is continuous', () => {
    fc.assert(
      fc.property(place, periods, counts, (p, by, count) => {
        const value = curl(p, count, 7)
        const there = curl(moved(p, by), count, 7)
        const close = curl(moved(p, [1e-7, 1e-7, 1e-7]), count, 7)
        for (let axis = 0; axis < 3; axis++) {
          expect(there[axis]).toBeCloseTo(value[axis], 9)
          expect(Math.abs(close[axis] - value[axis])).toBeLessThan(1e-4)
        }
      })
    )
  })

  it('is that of the potentials', () => {
    const step = 1e-6
    fc.assert(
      fc.property(place, counts, (p, count) => {
        const slope = (potential: number, axis: number): number => {
          const ends = [step, -step].map(by => potentials(along(p, axis, by), count, 7))
          return (ends[0][potential][0] - ends[1][potential][0]) / (2 * step * count)
        }
        const value = curl(p, count, 7)
        for (let axis = 0; axis < 3; axis++) {
          const [next, last] = [(axis + 1) % 3, (axis + 2) % 3]
          expect(value[axis]).toBeCloseTo(slope(last, next) - slope(next, last), 5)
        }
      })
    )
  })

  it('has no sources and no sinks', () => {
    const step = 1e-5
    fc.assert(
      fc.property(place, counts, (p, count) => {
        const slopes = [0, 1, 2].map(axis => {
          const ends = [step, -step].map(by => curl(along(p, axis, by), count, 7)[axis])
          return (ends[0] - ends[1]) / (2 * step * count)
        })
        expect(slopes[0] + slopes[1] + slopes[2]).toBeCloseTo(0, 4)
      })
    )
  })

  it('displaces by what a recipe says', () => {
    for (const [index, { terms }] of shapeChannels.entries()) {
      terms.forEach(({ stir }, i) => {
        let square = 0
        const samples = grid(16)
        for (const p of samples) {
          const seed = seedOf(index, terms.length + i)
          square += curl(p, stir!.cells, seed).reduce((sum, x) => sum + x * x, 0) / 3
        }
        const deviation = Math.sqrt(square / samples.length) / noiseDeviations.curl
        expect(Math.abs(deviation - 1), `channel ${index}, term ${i}`).toBeLessThan(0.05)
      })
    }
  })
})

describe('channelNoise', () => {
  it('takes every weather equally often', () => {
    for (const [i, channel] of weatherChannels.entries()) {
      const values = grid(28)
        .map(p => channelNoise(channel, FIRST_CHANNEL.weather + i, p))
        .toSorted((a, b) => a - b)
      let worst = 0
      values.forEach((value, n) => {
        worst = Math.max(worst, Math.abs(value - (n + 0.5) / values.length))
      })
      expect(worst, `channel ${i}`).toBeLessThan(0.03)
    }
  })
})

describe('encoded noise', () => {
  const curlIndex = FIRST_CHANNEL.shape + shapeChannels.length
  const encoded: [string, (p: Vec3Array) => number][] = [
    ['coarse billows', p => channelNoise(shapeChannels[0], FIRST_CHANNEL.shape, p)],
    ['fine billows', p => channelNoise(shapeChannels[1], FIRST_CHANNEL.shape + 1, p)],
    ['curl along x', p => curlNoise(curlIndex, p)[0]],
    ['curl along y', p => curlNoise(curlIndex, p)[1]],
    ['detail', p => channelNoise(detailChannel, FIRST_CHANNEL.detail, p)]
  ]

  it.for(encoded)('of %s has a mean of 0 and a deviation of 1', ([, noise]) => {
    let [sum, square] = [0, 0]
    const samples = grid(40)
    for (const p of samples) {
      const value = noise(p)
      const z = (value - 0.5) / ENCODING_SCALE
      sum += z / samples.length
      square += z ** 2 / samples.length
      if (value < 0 || value > 1) expect.fail(`${value} at ${p.join(' ')}`)
    }
    expect(Math.abs(sum)).toBeLessThan(0.02)
    expect(Math.abs(Math.sqrt(square - sum ** 2) - 1)).toBeLessThan(0.02)
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
      const values = grid(3).map(p => textures.sample('detail', p, level)[0])
      const mean = values.reduce((a, b) => a + b) / values.length
      return values.reduce((sum, v) => sum + (v - mean) ** 2, 0)
    }
    expect(spread(3)).toBeLessThan(0.3 * spread(0))
  })
})
