import { buildArgsParam } from 'storybook/internal/router'
import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { KEY, KeptSource, type SourceArgs } from '../src/photogrammetry/KeptSource'

const PARIS = 'https://tiles.example/paris.json'
const SECRET = 'AIzaSy-0123'
const EMPTY: SourceArgs = { url: '', [KEY]: '' }

/** A tab with an address and what it keeps, in which stories are opened one after another. */
function tabAt(hash = '') {
  const location = { pathname: '/story', search: '', hash }
  const replaceState = (_state: unknown, _title: string, url: string): void => {
    location.hash = url.slice(url.indexOf('#'))
  }
  const page = Object.assign(new EventTarget(), { location, history: { replaceState } })
  const kept = new Map<string, string>()
  const storage = {
    getItem: (name: string) => kept.get(name) ?? null,
    setItem: (name: string, value: string) => void kept.set(name, value),
    removeItem: (name: string) => void kept.delete(name)
  }
  const open = (args = EMPTY, restores = true) => {
    const asked: object[] = []
    const options = { restores, page: page as unknown as Window, storage }
    const source = new KeptSource(args, () => asked.push({ ...source.current }), options)
    return { source, asked }
  }
  const goTo = (address: string): void => {
    location.hash = address
    page.dispatchEvent(new Event('hashchange'))
  }
  return { location, kept, storage, open, goTo }
}

/** Contents that a source gives the story's fields. */
function shownBy(source: KeptSource): SourceArgs | undefined {
  let shown: SourceArgs | undefined
  source.show(changes => (shown = changes))
  return shown
}

beforeEach(() => vi.useFakeTimers())
afterEach(() => vi.useRealTimers())

it('asks for tiles half a second after the last keystroke', () => {
  const { source, asked } = tabAt().open()
  for (let i = 1; i <= PARIS.length; i++) {
    source.take({ url: PARIS.slice(0, i), [KEY]: '' })
    vi.advanceTimersByTime(400)
  }
  expect(asked).toEqual([])
  vi.advanceTimersByTime(100)
  expect(asked).toEqual([{ url: PARIS, key: '' }])
  expect(source.take({ url: PARIS, [KEY]: '' })).toBe(false)
  vi.advanceTimersByTime(1000)
  expect(asked).toHaveLength(1)
  source.take(EMPTY)
  source.dispose()
  vi.advanceTimersByTime(1000)
  expect(asked).toHaveLength(1)
})

it('has the URL in the address and the key in the tab, which a reload brings back', () => {
  const tab = tabAt()
  const { source } = tab.open()
  source.take({ url: PARIS, [KEY]: '' })
  source.take({ url: PARIS, [KEY]: SECRET })
  vi.advanceTimersByTime(1000)
  expect(decodeURIComponent(tab.location.hash)).toBe(`#tileset=${PARIS}`)
  source.dispose()
  const { source: again, asked } = tab.open()
  expect(again.current).toEqual({ url: PARIS, key: SECRET })
  expect(shownBy(again)).toEqual({ url: PARIS, [KEY]: SECRET })
  expect(shownBy(again)).toBeUndefined()
  // The fields have them now, and nothing is asked for again.
  expect(again.take({ url: PARIS, [KEY]: SECRET })).toBe(false)
  vi.advanceTimersByTime(1000)
  expect(asked).toEqual([])
  again.take({ url: PARIS, [KEY]: '' })
  vi.advanceTimersByTime(1000)
  expect([...tab.kept]).toEqual([])
})

it('has another story of the page begin without the tileset, but with the key', () => {
  const tab = tabAt('#tileset=ion:7')
  const { source } = tab.open()
  expect(shownBy(source)).toEqual({ url: 'ion:7', [KEY]: '' })
  source.take({ url: 'ion:7', [KEY]: '' })
  source.take(EMPTY)
  source.take({ url: '', [KEY]: SECRET })
  vi.advanceTimersByTime(1000)
  source.dispose()
  tab.location.hash = '#tileset=ion:7'
  expect(tab.open(EMPTY, false).source.current).toEqual({ url: '', key: SECRET })
})

it('gives a key to its server alone', () => {
  const tab = tabAt()
  const { source } = tab.open()
  source.take({ url: PARIS, [KEY]: SECRET })
  vi.advanceTimersByTime(1000)
  // By a link, and by hand.
  tab.goTo('#tileset=https%3A%2F%2Felsewhere.example%2Ftileset.json')
  expect(source.current).toEqual({ url: 'https://elsewhere.example/tileset.json', key: '' })
  tab.goTo(`#tileset=${encodeURIComponent(PARIS)}`)
  expect(source.current.key).toBe(SECRET)
  source.take({ url: 'ion:7', [KEY]: SECRET })
  expect(source.current).toEqual({ url: 'ion:7', key: '' })
  expect(shownBy(source)).toEqual({ url: 'ion:7', [KEY]: '' })
})

it('works where nothing may be kept', () => {
  const refuse = (): never => {
    throw new Error('denied')
  }
  const storage = { getItem: refuse, setItem: refuse, removeItem: refuse }
  const page = Object.assign(new EventTarget(), { location: { hash: '' } }) as unknown as Window
  const source = new KeptSource(EMPTY, () => {}, { page, storage })
  source.take({ url: '', [KEY]: SECRET })
  vi.advanceTimersByTime(499)
  expect(source.current.key).toBe(SECRET)
  source.dispose()
})

it('names the key as Storybook leaves it out of addresses', () => {
  vi.spyOn(console, 'warn').mockImplementation(() => {})
  const args = { ...EMPTY, place: 'local' }
  const changed = { ...args, [KEY]: SECRET, place: 'fuji' }
  expect(buildArgsParam(args, changed)).toBe('place:fuji')
})
