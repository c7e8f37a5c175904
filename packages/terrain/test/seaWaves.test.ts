import fc from 'fast-check'
import { expect, it } from 'vitest'
import { seaWaves, waterFresnel } from '../src/surface/cpu/seaSurface'
import {
  PERIOD,
  SEA_WAVES,
  seaSlopeVariance,
  WARP,
  WARPED,
  WARPS,
  WAVE_SHARE,
  WAVE_SLOPE
} from '../src/surface/seaWaves'

it('waves have their share of the slopes that Cox and Munk measured, wherever up is', () => {
  // 7 m/s: a standard deviation of 11°.
  expect((Math.atan(Math.sqrt(seaSlopeVariance(7))) * 180) / Math.PI).toBeCloseTo(11.1, 1)
  const directions = SEA_WAVES.map(({ vector }) => {
    const size = Math.hypot(...vector)
    return vector.map(part => part / size)
  })
  for (const up of directions) {
    let variance = 0
    for (const direction of directions) {
      const upward = direction.reduce((sum, part, i) => sum + part * up[i], 0)
      variance += (WAVE_SLOPE ** 2 / 2) * (1 - upward ** 2)
    }
    expect(variance).toBeGreaterThan(0.8 * WAVE_SHARE)
    expect(variance).toBeLessThan(1.2 * WAVE_SHARE)
  }
})

it('a warp adds to the slopes what it is said to, by a matrix that is its own transpose', () => {
  const square = WARPS.flat().reduce((sum, part) => sum + part ** 2, 0)
  expect(1 + (square * ((2 * Math.PI * WARP) / PERIOD) ** 2) / 6).toBeCloseTo(WARPED, 3)
  for (const i of [0, 1, 2]) for (const j of [0, 1, 2]) expect(WARPS[i][j]).toBe(WARPS[j][i])
})

it('waves repeat with the 256 m of references, and differ in length', () => {
  const lengths = SEA_WAVES.map(({ vector, length, frequency }) => {
    expect(vector.every(Number.isInteger)).toBe(true)
    // Deep water: the speed of a wave is g / 2πf.
    expect(frequency * length).toBeCloseTo(9.81 / (2 * Math.PI * frequency), 9)
    return length
  })
  expect(new Set(lengths).size).toBe(lengths.length)
  expect(Math.max(...lengths)).toBeLessThan(16)
  expect(Math.min(...lengths)).toBeGreaterThan(0.4)
})

it('smooth water reflects as Fresnel found: from all sides by 1 %, from one by 0.058', () => {
  const step = Math.PI / 1800
  let mean = 0
  let expectedMean = 0
  for (let angle = step / 2; angle < Math.PI / 2; angle += step) {
    const cosine = Math.cos(angle)
    const inside = Math.sqrt(1 - (Math.sin(angle) / 1.34) ** 2)
    const across = ((cosine - 1.34 * inside) / (cosine + 1.34 * inside)) ** 2
    const along = ((inside - 1.34 * cosine) / (inside + 1.34 * cosine)) ** 2
    const expected = (across + along) / 2
    const found = waterFresnel(cosine, 0)
    // Schlick's approximation is farthest off at 84°.
    expect(Math.abs(found - expected)).toBeLessThan(0.058)
    mean += 2 * cosine * Math.sin(angle) * step * found
    expectedMean += 2 * cosine * Math.sin(angle) * step * expected
  }
  expect(mean / expectedMean).toBeGreaterThan(0.99)
  expect(mean / expectedMean).toBeLessThan(1.01)
})

it('rough water reflects less at grazing angles, and as much from above', () => {
  expect(waterFresnel(1, 0.04)).toBeCloseTo(0.0211, 4)
  fc.assert(
    fc.property(
      fc.double({ min: 0, max: 1, noNaN: true }),
      fc.double({ min: 1e-3, max: 0.2, noNaN: true }),
      (cosine, variance) => {
        const rough = waterFresnel(cosine, variance)
        expect(rough).toBeLessThanOrEqual(waterFresnel(cosine, 0))
        expect(rough).toBeGreaterThan(0.021)
      }
    )
  )
  expect(waterFresnel(0, 0.039)).toBeLessThan(0.4)
})

it('waves have the variance that roughness lacks, and lie along the ground', () => {
  const up = [0.6, 0, 0.8] as const
  const variance = seaSlopeVariance(7)
  const rest = seaWaves([0, 0, 0], up, 0.01, variance, 0)
  let square = 0
  const count = 4000
  for (let i = 0; i < count; i++) {
    // Low-discrepancy places of the period of 256 m.
    const [a, b] = [(i * 0.7548776662) % 1, (i * 0.569840291) % 1]
    const offset = [256 * a, 256 * b, 256 * ((i * 0.430159709) % 1)] as const
    const { slope } = seaWaves(offset, up, 0.01, variance, 12)
    const [x, y, z] = slope
    expect(Math.abs(x * up[0] + y * up[1] + z * up[2])).toBeLessThan(1e-12)
    square += (x * x + y * y + z * z) / count
  }
  expect(square / (variance - rest.variance)).toBeGreaterThan(0.85)
  expect(square / (variance - rest.variance)).toBeLessThan(1.15)
  // From afar there are none.
  const far = seaWaves([3, 4, 5], up, 20, variance, 12)
  expect(Math.hypot(...far.slope)).toBe(0)
  expect(far.variance).toBe(variance)
})
