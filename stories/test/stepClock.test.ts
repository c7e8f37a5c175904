import { expect, it } from 'vitest'
import { StepClock } from '../src/valley/StepClock'

const RATE = 72
const FRAME = 1 / 60

it('loses no time, and moves the sun in one of several frames', () => {
  const clock = new StepClock()
  const moves = Array.from({ length: 600 }, () => FRAME * clock.rateNow(FRAME, RATE))
  const moved = moves.filter(seconds => seconds > 0)
  expect(moved.length).toBeLessThan(600 / 4)
  expect(Math.max(...moved)).toBeLessThan(5 + FRAME * RATE)
  expect(moves.reduce((sum, seconds) => sum + seconds, 0)).toBeGreaterThan(600 * FRAME * RATE - 5)
})

it('moves the sun in each frame of a fast day', () => {
  const clock = new StepClock()
  const rate = 86_400 / 60
  expect([1, 2, 3].map(() => clock.rateNow(FRAME, rate))).toEqual([rate, rate, rate])
})

it('keeps no time of a stopped clock, and stands in frames of no length', () => {
  const clock = new StepClock()
  for (let i = 0; i < 100; i++) expect(clock.rateNow(1, 0)).toBe(0)
  expect(clock.rateNow(0, RATE)).toBe(0)
  expect(clock.rateNow(FRAME, RATE)).toBe(0)
})
