import { expect, it } from 'vitest'
import { selectStills, stills } from '../stills/scenes'

const names = (words: string[]): string[] => selectStills(words).map(({ name }) => name)

it('has every still once', () => {
  const all = names([])
  expect(all).toHaveLength(stills.length)
  expect(new Set(all).size).toBe(all.length)
})

it('takes names, and prefixes where no still has the name', () => {
  expect(names(['among'])).toEqual(['among'])
  expect(names(['mars'])).toEqual(['mars-noon', 'mars-sunset'])
  expect(names(['night', '400km'])).toEqual(['400km', 'night-moon', 'night-stars'])
})

it('tells all names when one is wrong', () => {
  expect(() => selectStills(['clear-non'])).toThrow(/'clear-non'; there are .*clear-noon/)
})
