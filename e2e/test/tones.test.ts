import { expect, it } from 'vitest'
import { tonesOf } from '../harness/tones'

it('counts pixels with a channel at white, and averages the channels', () => {
  const pixels = [0, 0, 0, 255, 255, 0, 0, 255, 253, 253, 253, 255, 254, 0, 51, 255]
  const mean = (255 + 3 * 253 + 254 + 51) / 12 / 255
  expect(tonesOf(pixels, 255).mean).toBeCloseTo(mean, 12)
  expect(tonesOf(pixels, 255).clipped).toBe(0.5)
  const floats = pixels.map(value => value / 255)
  expect(tonesOf(floats, 1).clipped).toBe(0.5)
})
