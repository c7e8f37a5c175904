import { expect, it } from 'vitest'
import { SEA_WAVES, seaSlopeVariance, WAVE_SHARE, WAVE_SLOPE } from '../src/surface/seaWaves'

it('waves have their share of the slopes that Cox and Munk measured, wherever up is', () => {
  // 7 m/s: a standard deviation of 11°.
  expect((Math.atan(Math.sqrt(seaSlopeVariance(7))) * 180) / Math.PI).toBeCloseTo(11.1, 1)
  const ups = SEA_WAVES.flatMap(({ direction }) => [direction])
  for (const up of ups) {
    let variance = 0
    for (const { direction } of SEA_WAVES) {
      const upward = direction.reduce((sum, part, i) => sum + part * up[i], 0)
      variance += (WAVE_SLOPE ** 2 / 2) * (1 - upward ** 2)
    }
    expect(variance).toBeGreaterThan(0.8 * WAVE_SHARE)
    expect(variance).toBeLessThan(1.2 * WAVE_SHARE)
  }
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
