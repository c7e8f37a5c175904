import { isOthers } from '../moving/ExplorerInput'

/**
 * Shares the mouse between an explorer and controls of a globe: these have drags with other buttons and with Ctrl, and the wheel
 * with Ctrl; what the explorer takes breaks off what they do.
 *
 * @param controls - Controls of the globe, on the same canvas.
 * @param areFree - True while they may move the camera.
 * @returns Function that ends it.
 */
export function shareMouse(
  canvas: HTMLElement,
  controls: { enabled: boolean },
  areFree: () => boolean
): () => void {
  const ending = new AbortController()
  controls.enabled = false
  const share = (event: PointerEvent | WheelEvent): void => {
    controls.enabled = isOthers(event) && areFree()
  }
  // Before the controls see the event.
  const options = { signal: ending.signal, capture: true, passive: true }
  canvas.addEventListener('pointerdown', share, options)
  canvas.addEventListener('wheel', share, options)
  return () => ending.abort()
}
