import { afterEach, beforeEach, describe, expect, it, vi } from 'vitest'
import { loadPixels } from '../../src/data/loadPixels'
import { tileKey, tileOfKey } from '../../src/data/mercator'
import { TileCache } from '../../src/data/TileCache'
import { PermanentFailure, TileRequests } from '../../src/data/TileRequests'
import { tileUrl } from '../../src/data/tileUrl'

const settings = { concurrency: 1, retries: 2, backOff: 0.5 }
const never = new AbortController().signal

describe('requests', () => {
  beforeEach(() => void vi.useFakeTimers())
  afterEach(() => void vi.useRealTimers())

  it('are served by priority, and of equal ones the newest first', async () => {
    const order: number[] = []
    const requests = new TileRequests(async key => {
      order.push(key)
      return key
    }, settings)
    const priorities = [5, 2, 2, 1, 9]
    await Promise.all(priorities.map((priority, key) => requests.get(key, priority, never)))
    expect(order).toEqual([0, 3, 2, 1, 4])
    expect(requests.size).toBe(0)
  })

  it('are made once for all who wait, and given up when the last one leaves', async () => {
    const signals: AbortSignal[] = []
    const requests = new TileRequests((_, signal) => {
      signals.push(signal)
      return new Promise<number>(() => {})
    }, settings)
    const [first, second] = [new AbortController(), new AbortController()]
    const waits = [first, second].map(({ signal }) => requests.get(7, 0, signal))
    expect(signals.length).toBe(1)
    first.abort()
    await expect(waits[0]).rejects.toThrow('aborted')
    expect(signals[0].aborted).toBe(false)
    second.abort()
    await expect(waits[1]).rejects.toThrow('aborted')
    expect(signals[0].aborted).toBe(true)
    expect(requests.size).toBe(0)
    await expect(requests.get(7, 0, first.signal)).rejects.toThrow('aborted')
  })

  it('of one page, however many, add no listeners to its signal, and are given up with it', async () => {
    const page = new AbortController()
    const { signal } = page
    const add = vi.spyOn(signal, 'addEventListener')
    const requests = new TileRequests(() => new Promise<number>(() => {}), settings)
    const all = Array.from({ length: 30 }, (_, key) => requests.get(key, 0, signal))
    expect(add.mock.calls.length).toBeLessThan(2)
    expect(requests.size).toBe(30)
    page.abort()
    const answers = await Promise.allSettled(all)
    expect(answers.every(({ status }) => status === 'rejected')).toBe(true)
    expect(requests.size).toBe(0)
  })

  it('wait twice as long before each retry, and leave room for others meanwhile', async () => {
    const times: number[] = []
    const start = Date.now()
    const requests = new TileRequests(async key => {
      if (key === 1) return 'other'
      times.push(Date.now() - start)
      throw new Error('down')
    }, settings)
    const failed = requests.get(0, 0, never).catch((error: Error) => error.message)
    await vi.advanceTimersByTimeAsync(100)
    expect(await requests.get(1, 0, never)).toBe('other')
    await vi.advanceTimersByTimeAsync(5000)
    expect(await failed).toBe('down')
    expect(times).toEqual([0, 500, 1500])
  })

  it('are not made again after a final failure, nor after the end', async () => {
    let count = 0
    const requests = new TileRequests(async key => {
      count++
      throw key === 0 ? new PermanentFailure('none') : new Error('down')
    }, settings)
    await expect(requests.get(0, 0, never)).rejects.toThrow('none')
    await vi.advanceTimersByTimeAsync(5000)
    expect(count).toBe(1)
    // One that rests before its next attempt.
    const rest = requests.get(1, 0, never).catch((error: Error) => error.message)
    await vi.advanceTimersByTimeAsync(100)
    expect(count).toBe(2)
    requests.clear()
    expect(await rest).toContain('aborted')
    await vi.advanceTimersByTimeAsync(5000)
    expect([count, requests.size]).toEqual([2, 0])
  })
})

it('a picture that the server says is not there is none, and any other answer may change', async () => {
  const answer = vi.fn<typeof fetch>()
  vi.stubGlobal('fetch', answer)
  for (const status of [204, 400, 403, 404, 410]) {
    answer.mockResolvedValueOnce(new Response(null, { status }))
    expect(await loadPixels('tile', never)).toBeNull()
  }
  for (const status of [401, 429, 500, 503]) {
    answer.mockResolvedValueOnce(new Response(null, { status }))
    await expect(loadPixels('tile', never)).rejects.toThrow(`tile: ${status}`)
  }
  vi.unstubAllGlobals()
})

it('a cache lets go of what was not used for the longest time', () => {
  const cache = new TileCache<string>(30, key => key === 0)
  for (const key of [0, 1, 2]) cache.set(key, `${key}`, 10)
  cache.get(1)
  cache.set(3, '3', 10)
  expect([0, 1, 2, 3].map(key => cache.peek(key))).toEqual(['0', '1', undefined, '3'])
  cache.set(3, 'again', 20)
  expect(cache.bytes).toBe(30)
  expect(cache.peek(1)).toBeUndefined()
  cache.clear()
  expect([cache.size, cache.bytes]).toEqual([0, 0])
})

it('keys of tiles go there and back, around the planet', () => {
  for (const [z, x, y] of [
    [0, 0, 0],
    [5, 31, 0],
    [22, 4_000_001, 4_194_303]
  ]) {
    expect(tileOfKey(tileKey(z, x, y))).toEqual({ z, x, y })
  }
  expect(tileOfKey(tileKey(3, -1, 9))).toEqual({ z: 3, x: 7, y: 7 })
})

describe('addresses', () => {
  it('are those of XYZ, TMS and WMTS', () => {
    expect(tileUrl('h/{z}/{x}/{y}.png')(3, 5, 1)).toBe('h/3/5/1.png')
    expect(tileUrl('h/{z}/{x}/{-y}')(3, 5, 1)).toBe('h/3/5/6')
    expect(tileUrl('h?m={TileMatrix}&c={TileCol}&r={TileRow}')(3, 5, 1)).toBe('h?m=3&c=5&r=1')
    expect(tileUrl('{s}/{z}/{x}/{y}', ['a', 'b'])(3, 5, 2)).toBe('b/3/5/2')
  })

  it.each<[string, () => unknown]>([
    ['template must be a string', () => tileUrl(3 as never)],
    ['template must have {y} or {-y} or {TileRow}', () => tileUrl('{z}/{x}')],
    ['template must not have {q}', () => tileUrl('{z}/{x}/{y}/{q}')],
    ['subdomains must not be empty', () => tileUrl('{s}/{z}/{x}/{y}')]
  ])('are refused: %s', (message, make) => {
    expect(make).toThrow(message)
  })
})
