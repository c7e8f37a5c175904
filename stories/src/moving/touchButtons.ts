import type { Explorer } from './Explorer'

/** Buttons for moves that fingers on the picture lack, and the keys that they hold. */
const BUTTONS = [
  ['Up', 'KeyE'],
  ['Down', 'KeyQ'],
  ['Walk', 'KeyF'],
  ['Jump', 'Space']
] as const

/**
 * Adds buttons to go up and down, walk and jump, which move as long as a finger is on them. They show from the start where
 * fingers are all that there is, else from the first touch on.
 *
 * @param element - Parent of the buttons, hidden so far.
 * @param canvas - Element whose first touch shows them.
 */
export function addTouchButtons(
  element: HTMLElement,
  canvas: HTMLElement,
  explorer: Explorer
): void {
  for (const [label, code] of BUTTONS) {
    const button = document.createElement('button')
    button.textContent = label
    button.addEventListener('pointerdown', ({ pointerId }) => {
      button.setPointerCapture(pointerId)
      explorer.press(code)
    })
    for (const end of ['pointerup', 'pointercancel', 'lostpointercapture'] as const) {
      button.addEventListener(end, () => explorer.release(code))
    }
    // A long touch is no request for a menu.
    button.addEventListener('contextmenu', event => event.preventDefault())
    element.append(button)
  }
  element.hidden = !matchMedia('(pointer: coarse)').matches
  const show = ({ pointerType }: PointerEvent): void => {
    if (pointerType !== 'touch') return
    element.hidden = false
    canvas.removeEventListener('pointerdown', show)
  }
  canvas.addEventListener('pointerdown', show)
}
