import { afterEach, expect, it, vi } from 'vitest'
import { loadPixels } from '../../src/data/loadPixels'

afterEach(() => {
  vi.unstubAllGlobals()
  vi.restoreAllMocks()
})

it('fails if a server hangs', async () => {
  const late = new AbortController()
  const timeout = vi.spyOn(AbortSignal, 'timeout').mockReturnValue(late.signal)
  vi.stubGlobal(
    'fetch',
    (_: string, { signal }: { signal: AbortSignal }) =>
      new Promise((_resolve, reject) => {
        signal.addEventListener('abort', () => reject(new Error('given up')))
      })
  )
  const pixels = loadPixels('https://example.org/0/0/0.png', new AbortController().signal)
  late.abort()
  await expect(pixels).rejects.toThrow('given up')
  expect(timeout).toHaveBeenCalledWith(30_000)
}, 1000)
