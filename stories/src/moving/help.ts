import type { Explorer } from './Explorer'
import { TYPED } from './ExplorerInput'

/** Time for which the keys are shown at first [ms]. */
const SHOWN = 9000

/** Mark of a line that is hidden. */
const HIDDEN = '?'

const KEYS = 'WASD, Q, E fly · Shift is faster · F walks, Space jumps'

/** Line that says how one moves. */
export function helpFor({ others }: Explorer, isTouched: boolean): string {
  if (isTouched) return 'One finger looks, two move, buttons rise, walk and jump'
  const aside = others === undefined ? '' : ` · ${others}`
  return `Drag looks · ${KEYS} · wheel sets the speed${aside}`
}

/**
 * Shows how one moves, for some seconds; then a question mark stays, which brings the line back, as the key H does.
 *
 * @returns Ends it.
 */
export function showHelp(button: HTMLElement, explorer: Explorer): () => void {
  const isTouched = matchMedia('(pointer: coarse)').matches
  const line = helpFor(explorer, isTouched) + (isTouched ? '' : ' · H hides this')
  const ending = new AbortController()
  const { signal } = ending
  const show = (isShown: boolean): void => {
    button.textContent = isShown ? line : HIDDEN
    button.ariaExpanded = String(isShown)
  }
  const timer = setTimeout(() => show(false), SHOWN)
  const toggle = (): void => {
    clearTimeout(timer)
    show(button.textContent === HIDDEN)
  }
  button.hidden = false
  button.ariaLabel = 'How one moves'
  show(true)
  button.addEventListener('click', toggle, { signal })
  const press = ({ code, target, ctrlKey, metaKey, altKey }: KeyboardEvent): void => {
    const isTyped = (target as Partial<Element> | null)?.closest?.(TYPED)
    if (code === 'KeyH' && !ctrlKey && !metaKey && !altKey && !isTyped) toggle()
  }
  window.addEventListener('keydown', press, { signal })
  return () => {
    clearTimeout(timer)
    ending.abort()
  }
}
