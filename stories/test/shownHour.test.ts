import { expect, it } from 'vitest'
import { ShownHour } from '../src/ShownHour'

/** An hour in the controls, and the clock that runs beside it [ms]. */
function shownAt(hour: number) {
  const clock = { now: 0 }
  return { clock, shown: new ShownHour(hour, () => clock.now) }
}

it('shows the hour of a running clock every three seconds, in hundredths that it has reached', () => {
  const { clock, shown } = shownAt(8)
  clock.now = 2900
  expect(shown.next(8.06)).toBeUndefined()
  clock.now = 3000
  expect(shown.next(8.1678)).toBe(8.16)
  expect(shown.next(8.1678)).toBeUndefined()
  clock.now = 6000
  expect(shown.next(8.2)).toBe(8.2)
})

it('tells an hour that was set by hand from one that it has shown itself', () => {
  const { clock, shown } = shownAt(8)
  clock.now = 3000
  expect(shown.next(8.3)).toBe(8.3)
  expect(shown.take(8.3, 8)).toBe(false)
  expect(shown.byHand).toBe(8)
  expect(shown.take(16, 8.3)).toBe(true)
  expect(shown.byHand).toBe(16)
})

it('waits after any change by hand', () => {
  const { clock, shown } = shownAt(8)
  clock.now = 2500
  shown.take(8, 8)
  clock.now = 5000
  expect(shown.next(8.2)).toBeUndefined()
  clock.now = 5500
  expect(shown.next(8.2)).toBe(8.2)
})
