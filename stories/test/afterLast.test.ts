import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { afterLast } from '../src/afterLast'

beforeEach(() => vi.useFakeTimers())
afterEach(() => vi.useRealTimers())

it('acts once, some time after the last call', () => {
  const act = vi.fn<() => void>()
  const { ask, cancel } = afterLast(200, act)
  for (let i = 0; i < 20; i++) {
    ask()
    vi.advanceTimersByTime(150)
  }
  expect(act).not.toHaveBeenCalled()
  vi.advanceTimersByTime(50)
  expect(act).toHaveBeenCalledTimes(1)
  vi.advanceTimersByTime(1000)
  expect(act).toHaveBeenCalledTimes(1)
  ask()
  cancel()
  vi.advanceTimersByTime(1000)
  expect(act).toHaveBeenCalledTimes(1)
})
