import { expect, it } from 'vitest'
import { ViewChange } from '../src/moving/ViewChange'

const shower = { name: 'shower' }
const snow = { name: 'snow' }

it('goes from one view to the next without a jump: its clouds are gone when they are others', () => {
  const change = new ViewChange(shower, { sun: 30, exposure: 0 })
  expect([change.shown, change.part, change.numbers]).toEqual([shower, 1, { sun: 30, exposure: 0 }])
  expect(change.update(1)).toBe(false)
  change.go(snow, { sun: 10, exposure: 1 }, 4)
  let [frames, before] = [0, change.numbers.sun]
  let [part, shown] = [change.part, change.shown]
  for (; change.update(1 / 60); frames++) {
    const { sun, exposure } = change.numbers
    expect(before - sun).toBeGreaterThanOrEqual(0)
    expect(before - sun).toBeLessThan(0.2)
    expect(exposure).toBeCloseTo((30 - sun) / 20, 9)
    expect(Math.abs(change.part - part)).toBeLessThan(0.05)
    if (change.shown !== shown) expect(change.part).toBeLessThan(0.05)
    ;[before, part, shown] = [sun, change.part, change.shown]
  }
  expect(frames).toBeGreaterThan(235)
  expect(frames).toBeLessThan(245)
  expect([change.shown, change.part, change.numbers]).toEqual([snow, 1, { sun: 10, exposure: 1 }])
})

it('takes what sliders say at once, on the way by its end', () => {
  const change = new ViewChange(shower, { sun: 30 })
  change.set({ sun: 25 })
  expect(change.numbers).toEqual({ sun: 25 })
  change.go(snow, { sun: 10 }, 2)
  change.update(1)
  change.set({ sun: 40 })
  expect(change.numbers.sun).toBeCloseTo(32.5, 9)
  change.update(1)
  expect(change.numbers).toEqual({ sun: 40 })
})

it('is there at once where there is no time, and starts anew from where it is', () => {
  const change = new ViewChange(shower, { sun: 30 })
  change.go(snow, { sun: 10 }, 0)
  expect([change.shown, change.part, change.numbers]).toEqual([snow, 1, { sun: 10 }])
  change.go(shower, { sun: 30 }, 2)
  change.update(0.7)
  const { part, numbers } = change
  expect(part).toBeLessThan(0.9)
  change.go(snow, { sun: 0 }, 2)
  expect(change.numbers).toEqual(numbers)
  expect(change.part).toBe(part)
})
