import { beforeEach, expect, it, vi } from 'vitest'
import { mount } from '../src/mount'
import type { RendererArgs, SceneHandle } from '../src/scene'

interface Args extends RendererArgs {
  view: string
  haze: number
}

/** Element of a page, as far as stories ask. */
function element(): Record<string, unknown> {
  const own: Record<string, unknown> = { style: {}, dataset: {}, isConnected: true }
  const parts = new Map<string, unknown>()
  const part = (name: string): unknown => parts.set(name, parts.get(name) ?? element()).get(name)
  const put = (child: unknown): unknown => covers.push(child)
  return Object.assign(own, {
    ownerDocument: page,
    querySelector: part,
    after: put,
    append: put,
    remove: () => covers.splice(0),
    toDataURL: () => 'data:last-picture'
  })
}

/** Pictures over the canvas. */
const covers: unknown[] = []
const page = { body: { dataset: {} }, createElement: () => element() }

const emitted: unknown[][] = []
beforeEach(() => {
  covers.length = emitted.length = 0
  vi.stubGlobal('document', page)
  vi.stubGlobal('window', {
    __STORYBOOK_ADDONS_CHANNEL__: { emit: (...values: unknown[]) => emitted.push(values) }
  })
  vi.stubGlobal(
    'ResizeObserver',
    class {
      observe(): void {}
      disconnect(): void {}
    }
  )
  vi.useFakeTimers()
})

const args: Args = { view: 'deck', haze: 12, forceWebGL: false, path: 'post', frame: false }

/** A story whose views take scenes of their own. */
function story() {
  const made: Args[] = []
  let finish = (): void => {}
  const create = async (_: unknown, given: Args): Promise<SceneHandle<Args>> => {
    made.push(given)
    return {
      renderer: { setAnimationLoop: async () => {} },
      ready: new Promise<void>(resolve => (finish = resolve)),
      progress: 1,
      render() {},
      resize() {},
      update() {},
      dispose() {}
    } as unknown as SceneHandle<Args>
  }
  const show = mount(
    create,
    '',
    ({ view }) => view,
    ({ view }) => ({ haze: view.length })
  )
  return { made, show, finish: () => finish() }
}

it('has a new scene of a story fade in over the last picture, with the arguments that go with it', async () => {
  const { made, show, finish } = story()
  show(args, { id: 'shafts' })
  await vi.advanceTimersByTimeAsync(1)
  expect([made, covers, emitted]).toEqual([[args], [], []])
  finish()
  await vi.advanceTimersByTimeAsync(1)
  show({ ...args, view: 'storm' }, { id: 'shafts' })
  await vi.advanceTimersByTimeAsync(1)
  expect(made[1]).toEqual({ ...args, view: 'storm', haze: 5 })
  const updatedArgs = { haze: 5 }
  expect(emitted).toEqual([['updateStoryArgs', { storyId: 'shafts', updatedArgs }]])
  const [cover] = covers as [{ src: string; style: { opacity?: string } }]
  expect([cover.src, cover.style.opacity]).toEqual(['data:last-picture', undefined])
  finish()
  await vi.advanceTimersByTimeAsync(1)
  expect(cover.style.opacity).toBe('0')
  await vi.advanceTimersByTimeAsync(2000)
  expect(covers).toEqual([])
})

it('has another story begin as it is', async () => {
  const { made, show } = story()
  show(args, { id: 'a' })
  await vi.advanceTimersByTimeAsync(1)
  show({ ...args, view: 'storm' }, { id: 'b' })
  await vi.advanceTimersByTimeAsync(1)
  expect(made[1]).toEqual({ ...args, view: 'storm' })
  expect([covers, emitted]).toEqual([[], []])
})
