import { afterEach, describe, expect, it, vi } from 'vitest'
import { askServer } from '../src/tileServer'

const TEMPLATE = 'https://tiles.example.org/{z}/{x}/{y}.png'
const village = { longitude: -84.3, latitude: 36.4 }

function serve(answer: (url: string) => Response): string[] {
  const asked: string[] = []
  vi.stubGlobal('fetch', (url: string) => {
    asked.push(url)
    return Promise.resolve(answer(url))
  })
  return asked
}

const ok = (): Response => new Response('', { status: 200 })
const missing = (): Response => new Response('', { status: 404 })

describe('askServer', () => {
  afterEach(() => vi.unstubAllGlobals())

  it('finds the coarsest level of a server that begins with 5', async () => {
    const asked = serve(url => (url.includes('/5/8/12.png') ? ok() : missing()))
    expect(await askServer(TEMPLATE, village)).toEqual({ minZoom: 5 })
    expect(asked).toHaveLength(6)
  })

  it('asks a server that has all levels once', async () => {
    const asked = serve(ok)
    expect(await askServer(TEMPLATE, village)).toEqual({ minZoom: 0 })
    expect(asked).toEqual(['https://tiles.example.org/0/0/0.png'])
  })

  it('tells the first status of a server that has none', async () => {
    serve(missing)
    expect(await askServer(TEMPLATE, village)).toEqual({ problem: 'the server answers 404' })
  })

  it('tells what is wrong with a template or a network at once', async () => {
    const asked = serve(ok)
    expect(await askServer('https://tiles.example.org/', village)).toHaveProperty('problem')
    expect(asked).toHaveLength(0)
    vi.stubGlobal('fetch', () => Promise.reject(new Error('no network')))
    expect(await askServer(TEMPLATE, village)).toEqual({ problem: 'no network' })
  })
})
