import { Atmosphere } from '@welkin/atmosphere'
import { expect, it } from 'vitest'
import { linearSRGBColumns } from '../../src/air/cpu/color'
import { SUNLIGHT } from '../../src/exposure/tsl/photographicToneMapping'

it('the white of photographs is sunlight above the air', () => {
  const columns = linearSRGBColumns(new Atmosphere().parameters, 1)
  const [red, green, blue] = [0, 1, 2].map(row =>
    columns.reduce((sum, column) => sum + column[row], 0)
  )
  expect(red / green).toBeCloseTo(SUNLIGHT[0], 3)
  expect(blue / green).toBeCloseTo(SUNLIGHT[2], 3)
})
