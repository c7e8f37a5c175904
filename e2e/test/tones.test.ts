import { expect, it } from 'vitest'
import { toneFault, tonesOf } from '../harness/tones'

it('counts pixels with a channel at white, and averages the channels', () => {
  const pixels = [0, 0, 0, 255, 255, 0, 0, 255, 253, 253, 253, 255, 254, 0, 51, 255]
  const mean = (255 + 3 * 253 + 254 + 51) / 12 / 255
  expect(tonesOf(pixels, 255).mean).toBeCloseTo(mean, 12)
  expect(tonesOf(pixels, 255).clipped).toBe(0.5)
  const floats = pixels.map(value => value / 255)
  expect(tonesOf(floats, 1).clipped).toBe(0.5)
})

it('finds fault with pictures that are too bright, too dark or clipped', () => {
  const fault = (mean: number, clipped: number, luminance: number, isInSpace = false) =>
    toneFault({ mean, clipped }, luminance, isInSpace)
  expect(fault(0.48, 0.03, 3000)).toBeUndefined()
  expect(fault(0.508, 0, 3000)).toBe('its mean is 0.508, not 0.2 to 0.5')
  expect(fault(0.48, 0.031, 3000)).toBe('3.1 % is clipped, not 3 % at most')
  expect(fault(0.16, 0, 3000)).toBe('its mean is 0.160, not 0.2 to 0.5')
  expect(fault(0.16, 0, 3000, true)).toBeUndefined()
  expect(fault(0.16, 0, 0.005)).toBeUndefined()
  expect(fault(0.45, 0, 0.005)).toBe('its mean is 0.450, not 0.04 to 0.35')
  expect(fault(0.01, 0, 0.005)).toBe('its mean is 0.010, not 0.04 to 0.35')
  expect(fault(NaN, 0, 3000)).toBe('its mean is NaN, not 0.2 to 0.5')
})

it('lets the rest be bright where a dark part is exposed for, and dark where a bright one is', () => {
  const fault = (mean: number, clipped: number, compensation: number) =>
    toneFault({ mean, clipped }, 0.005, false, compensation)
  expect(fault(0.1, 0.1, 1)).toBeUndefined()
  expect(fault(0.03, 0, 1)).toBe('its mean is 0.030, not 0.04 at least')
  expect(fault(0.03, 0, -1)).toBeUndefined()
})
