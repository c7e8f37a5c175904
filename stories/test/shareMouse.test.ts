import { expect, it } from 'vitest'
import { shareMouse } from '../src/globe/shareMouse'

/** A canvas whose mouse an explorer and controls share, and what the controls see. */
function shared(areFree: () => boolean) {
  const canvas = new EventTarget()
  const controls = { enabled: true }
  const end = shareMouse(canvas as HTMLElement, controls, areFree)
  const taken: boolean[] = []
  for (const type of ['pointerdown', 'wheel']) {
    canvas.addEventListener(type, () => taken.push(controls.enabled))
  }
  const send = (type: string, values: object): boolean | undefined => {
    const event = Object.assign(new Event(type), { ctrlKey: false, ...values })
    canvas.dispatchEvent(event)
    return taken.at(-1)
  }
  return { controls, end, send }
}

it('lets controls of a globe have other buttons and Ctrl, and an explorer the rest', () => {
  const { controls, send } = shared(() => true)
  expect(controls.enabled).toBe(false)
  const mouse = { pointerType: 'mouse', button: 0 }
  expect(send('pointerdown', mouse)).toBe(false)
  expect(send('pointerdown', { ...mouse, button: 2 })).toBe(true)
  expect(send('wheel', {})).toBe(false)
  expect(send('wheel', { ctrlKey: true })).toBe(true)
  expect(send('pointerdown', { ...mouse, ctrlKey: true })).toBe(true)
  expect(send('pointerdown', { pointerType: 'touch', button: 0 })).toBe(false)
})

it('lets them have nothing while one walks, and leaves them alone in the end', () => {
  const { controls, end, send } = shared(() => false)
  expect(send('pointerdown', { pointerType: 'mouse', button: 2 })).toBe(false)
  end()
  controls.enabled = true
  expect(send('pointerdown', { pointerType: 'mouse', button: 0 })).toBe(true)
})
