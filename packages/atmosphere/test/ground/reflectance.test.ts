import { describe, expect, it } from 'vitest'
import { AtmosphereParameters } from '@welkin/atmosphere'
import { whiteBalancedColumns } from '../../src/air/cpu/color'
import { reflectanceColumns } from '../../src/ground/cpu/reflectance'

describe('reflectanceColumns', () => {
  it('looks, in sunlight, like the colour that it was made from', () => {
    const earth = new AtmosphereParameters()
    const columns = reflectanceColumns(earth)
    const seen = whiteBalancedColumns(earth)
    for (const color of [
      [1, 1, 1],
      [0.3, 0.2, 0.1],
      [0.02, 0.05, 0.2]
    ]) {
      const spectrum = [0, 1, 2, 3].map(i =>
        columns.reduce((sum, column, channel) => sum + column[i] * color[channel], 0)
      )
      const again = [0, 1, 2].map(row =>
        seen.reduce((sum, column, i) => sum + column[row] * spectrum[i], 0)
      )
      color.forEach((value, i) => expect(again[i]).toBeCloseTo(value, 10))
      if (color[0] === 1) spectrum.forEach(value => expect(value).toBeCloseTo(1, 10))
    }
  })
})
