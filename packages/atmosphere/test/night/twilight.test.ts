import { describe, expect, it } from 'vitest'
import { almanacIlluminance } from '../../src/night/cpu/twilight'

describe('almanac', () => {
  it('has the illuminance of the ends of the twilights', () => {
    // Explanatory Supplement, p. 492.
    expect(almanacIlluminance(-6)).toBeCloseTo(3.41, 1)
    expect(almanacIlluminance(-12)).toBeCloseTo(0.0081, 3)
    expect(almanacIlluminance(-18)).toBeCloseTo(0.00065, 4)
    expect(almanacIlluminance(-19)).toBe(almanacIlluminance(-18))
    expect(almanacIlluminance(90) / 128_800).toBeCloseTo(1, 2)
  })

  it('is continuous', () => {
    for (const elevation of [20, 5, -0.8, -5, -12]) {
      const ratio = almanacIlluminance(elevation + 1e-9) / almanacIlluminance(elevation - 1e-9)
      expect(Math.abs(ratio - 1), `${elevation}°`).toBeLessThan(0.03)
    }
  })
})
