import type { Explorer } from './Explorer'

/** Time for which the keys are shown [ms]. */
const SHOWN = 9000

const KEYS = 'WASD, Q, E fly · Shift is faster · F walks, Space jumps'

/** Line that says how one moves. */
export function helpFor({ drags }: Explorer, isTouched: boolean): string {
  if (drags === 'walking') {
    return isTouched ? 'Fingers turn the globe' : `Drag and wheel move the globe · ${KEYS}`
  }
  return isTouched
    ? 'One finger looks, two move, buttons rise, walk and jump'
    : `Drag looks · ${KEYS} · wheel sets the speed`
}

/** Shows how one moves, for some seconds. */
export function showHelp(element: HTMLElement, explorer: Explorer): void {
  element.textContent = helpFor(explorer, matchMedia('(pointer: coarse)').matches)
  element.style.opacity = '1'
  setTimeout(() => (element.style.opacity = '0'), SHOWN)
}
