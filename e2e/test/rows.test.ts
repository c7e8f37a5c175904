import { expect, it } from 'vitest'
import { rowsOf } from '../bench/rows'

const names = ['fair', 'fair, above', 'storm'] as const
const starts = (name: string, word: string): boolean => name.startsWith(word)

it('has all rows where none is asked for, else those that are named', () => {
  expect([...rowsOf('valley', names, [])]).toEqual(names)
  expect([...rowsOf('valley', names, ['fair'])]).toEqual(['fair'])
  expect([...rowsOf('valley', names, ['fair', 'st'], starts)]).toEqual(names)
})

it('measures nothing by a name that no row has', () => {
  expect(() => rowsOf('switches', names, ['storm', 'rainbw'])).toThrow(
    "bench: --rows of switches are fair; fair, above; storm; got 'rainbw'"
  )
  expect(() => rowsOf('valley', names, ['air'], starts)).toThrow("got 'air'")
})
