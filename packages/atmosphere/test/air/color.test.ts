import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import {
  linearSRGBColumns,
  spectralToLinearSRGB,
  whiteBalancedColumns,
  xyzToLinearSRGB
} from '../../src/air/cpu/color'

const earth = new AtmosphereParameters()

describe('colour', () => {
  it('shows D65 as white', () => {
    for (const value of xyzToLinearSRGB([0.95047, 1, 1.08883])) expect(value).toBeCloseTo(1, 3)
  })

  it('adds columns up to sunlight', () => {
    const columns = linearSRGBColumns(earth, 2)
    const sun = spectralToLinearSRGB(earth, earth.solarIrradiance)
    const balanced = whiteBalancedColumns(earth)
    for (const row of [0, 1, 2] as const) {
      const sum = columns.reduce((total, column) => total + column[row], 0)
      expect(sum / sun[row]).toBeCloseTo(2, 9)
      expect(balanced.reduce((total, column) => total + column[row], 0)).toBeCloseTo(1, 12)
    }
    const luminance = 0.2126 * sun[0] + 0.7152 * sun[1] + 0.0722 * sun[2]
    expect(Math.abs(luminance / 132_000 - 1)).toBeLessThan(0.02)
  })

  it('balances a white of nothing without dividing by zero', () => {
    const dark = new AtmosphereParameters({ solarIrradiance: [0, 0, 0, 0] })
    for (const column of whiteBalancedColumns(dark))
      expect(column.every(Number.isFinite)).toBe(true)
  })
})
