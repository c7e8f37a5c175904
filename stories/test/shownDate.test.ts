import { Atmosphere, DayCycle } from '@welkin/atmosphere'
import { expect, it } from 'vitest'
import { dateOfClock, ShownDate, wayTo } from '../src/valley/ShownDate'

const JUNE = Date.UTC(2026, 5, 1)
const DAY = 86_400_000

/** The valley's clock at an hour of a date's day. */
function clockAt(longitude: number, hour: number, date = JUNE): DayCycle {
  const atmosphere = new Atmosphere()
  atmosphere.place({ longitude, latitude: 46 })
  const cycle = new DayCycle(atmosphere)
  cycle.time = (Math.floor(date / DAY) + 0.5) * DAY
  cycle.hour = hour
  return cycle
}

it('finds the date that a clock was set to, at any hour and longitude', () => {
  for (const longitude of [-180, -179.9, -74, 0, 10, 139, 179.9, 180]) {
    for (const hour of [0, 0.01, 6, 11.99, 12, 12.01, 18, 23.99]) {
      const cycle = clockAt(longitude, hour)
      expect([longitude, hour, dateOfClock(cycle) - JUNE]).toEqual([longitude, hour, 0])
    }
  }
})

it('shows the next date after midnight, once', () => {
  const cycle = clockAt(10, 23.9)
  const shown = new ShownDate(JUNE + 3e7)
  expect(shown.next(cycle)).toBeUndefined()
  cycle.time += 3_600_000
  expect(shown.next(cycle)).toBe(JUNE + DAY)
  expect(shown.next(cycle)).toBeUndefined()
  // The controls have it now: the clock stays as it is, though it is a day further meanwhile.
  cycle.time += 23.5 * 3_600_000
  expect(shown.take(JUNE + DAY, JUNE, cycle)).toBe(false)
  expect(shown.date).toBe(JUNE + 2 * DAY)
  expect(wayTo(shown.date, cycle)).toBe(0)
})

it('keeps the clock running when something else is changed, before the date is shown', () => {
  const cycle = clockAt(10, 23.9)
  const shown = new ShownDate(JUNE)
  cycle.time += 3_600_000
  expect(shown.take(JUNE, JUNE, cycle)).toBe(false)
  expect(wayTo(shown.date, cycle)).toBe(0)
})

it('goes to a date that was set by hand, though it is the one before', () => {
  const cycle = clockAt(10, 23.9)
  const shown = new ShownDate(JUNE)
  cycle.time += 3_600_000
  shown.take(shown.next(cycle)!, JUNE, cycle)
  expect(shown.take(JUNE, JUNE + DAY, cycle)).toBe(true)
  expect(shown.date).toBe(JUNE)
  const { hour } = cycle
  cycle.time += wayTo(shown.date, cycle)
  expect([dateOfClock(cycle), cycle.hour]).toEqual([JUNE, expect.closeTo(hour, 6)])
})

it('keeps the day where another longitude has another', () => {
  const cycle = clockAt(10, 23)
  const shown = new ShownDate(JUNE)
  shown.take(JUNE, JUNE, cycle)
  cycle.atmosphere.place({ longitude: 170, latitude: 46 })
  cycle.hour = 23
  cycle.time += wayTo(shown.date, cycle)
  expect([dateOfClock(cycle), cycle.hour]).toEqual([JUNE, expect.closeTo(23, 6)])
})
