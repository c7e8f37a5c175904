import { afterEach, beforeEach, expect, it, vi } from 'vitest'
import { keepInUrl } from '../src/moving/urlState'

/** A page with an address, and nothing else. */
function pageAt(hash: string) {
  const location = { pathname: '/story', search: '?path=/story/plain', hash }
  const state = { of: 'Storybook' }
  const replaceState = vi.fn<(state: unknown, title: string, url: string) => void>(
    (_state, _title, url) => {
      location.hash = url.slice(url.indexOf('#'))
    }
  )
  const page = Object.assign(new EventTarget(), { location, history: { state, replaceState } })
  return { page: page as unknown as Window, location, state, replaceState }
}

beforeEach(() => vi.useFakeTimers())
afterEach(() => vi.useRealTimers())

it('writes what has changed, twice a second at most, beside what others have there', () => {
  const { page, state, replaceState } = pageAt('#hour=7')
  let value = '1,2'
  const end = keepInUrl(
    'view',
    () => value,
    () => {},
    { page }
  )
  vi.advanceTimersByTime(5000)
  expect(replaceState).not.toHaveBeenCalled()
  for (let i = 0; i < 100; i++) {
    value = `${i},é&=`
    vi.advanceTimersByTime(20)
  }
  expect(replaceState).toHaveBeenCalledTimes(4)
  expect(replaceState).toHaveBeenLastCalledWith(
    state,
    '',
    '/story?path=/story/plain#hour=7&view=99,%C3%A9%26%3D'
  )
  end()
  value = 'later'
  vi.advanceTimersByTime(5000)
  expect(replaceState).toHaveBeenCalledTimes(4)
})

it('takes what the address has, at once and when it changes', () => {
  const { page, location } = pageAt('#view=3,%C3%A9')
  const write = vi.fn<(value: string) => void>()
  keepInUrl('view', () => undefined, write, { page })
  expect(write).toHaveBeenLastCalledWith('3,é')
  location.hash = '#view=4'
  page.dispatchEvent(new Event('hashchange'))
  expect(write).toHaveBeenLastCalledWith('4')
  location.hash = '#'
  page.dispatchEvent(new Event('hashchange'))
  expect(write).toHaveBeenCalledTimes(2)
})

it('leaves a new scene as it is, and then the address has the new one', () => {
  const { page, location } = pageAt('#view=old')
  const write = vi.fn<(value: string) => void>()
  keepInUrl('view', () => 'new', write, { page, restores: false })
  vi.advanceTimersByTime(600)
  expect(write).not.toHaveBeenCalled()
  expect(location.hash).toBe('#view=new')
})

it('puts back what Storybook took off the address', () => {
  const { page, location } = pageAt('')
  let value = 'first'
  keepInUrl(
    'view',
    () => value,
    () => {},
    { page }
  )
  value = 'moved'
  vi.advanceTimersByTime(600)
  location.hash = ''
  vi.advanceTimersByTime(600)
  expect(location.hash).toBe('#view=moved')
})

it('puts arguments of a story where Storybook finds them again', () => {
  const { page, replaceState } = pageAt('#view=1,2&args=hour:8;exposure:2')
  keepInUrl(
    'view',
    () => '1,2',
    () => {},
    { page }
  )
  vi.advanceTimersByTime(600)
  const url = '/story?path=/story/plain&args=hour:8;exposure:2#view=1,2'
  expect(replaceState).toHaveBeenLastCalledWith(expect.anything(), '', url)
  expect(replaceState).toHaveBeenCalledTimes(1)
})
