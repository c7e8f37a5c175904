/** Time in which a picture fades [s]. */
const FADE_SECONDS = 1

/**
 * Lays a picture over a canvas, behind all else on its page.
 *
 * @param picture - Its address.
 * @returns Function that has the picture fade and go.
 */
export function coverWith(canvas: HTMLElement, picture: string): () => void {
  const image = canvas.ownerDocument.createElement('img')
  image.src = picture
  image.alt = ''
  Object.assign(image.style, {
    position: 'absolute',
    inset: '0',
    width: '100%',
    height: '100%',
    pointerEvents: 'none',
    transition: `opacity ${FADE_SECONDS}s`
  })
  canvas.after(image)
  return () => {
    image.style.opacity = '0'
    setTimeout(() => image.remove(), 1000 * FADE_SECONDS)
  }
}
