import { expect, it } from 'vitest'
import { sunElevation } from '../src/valley/HourArc'

it('has the sun as high as latitude and season say', () => {
  expect(sunElevation(12, 46, 0.25)).toBeCloseTo(90 - 46 + 23.44, 6)
  expect(sunElevation(12, 46, 0.75)).toBeCloseTo(90 - 46 - 23.44, 6)
  expect(sunElevation(0, 46, 0)).toBeCloseTo(-44, 6)
  expect(sunElevation(6, 46, 0)).toBeCloseTo(0, 6)
  expect(sunElevation(18, -30, 0.5)).toBeCloseTo(0, 6)
  expect(sunElevation(0, 80, 0.25)).toBeCloseTo(13.44, 6)
})
