/** Text in the upper right corner over a canvas; whoever makes it removes it. */
export function overlayOn(canvas: HTMLCanvasElement): HTMLElement {
  const element = document.createElement('div')
  element.setAttribute('role', 'status')
  element.style.cssText = `position: absolute; right: 12px; top: 12px; max-width: 45%; padding: 6px 10px;
    border-radius: 6px; background: rgb(5 7 10 / 70%); white-space: pre-line; pointer-events: none`
  canvas.parentElement?.append(element)
  return element
}
