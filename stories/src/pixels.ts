/**
 * Pixels of a picture, RGBA, from the lowest row up, as textures have them.
 *
 * @param name - Name of what asks, for errors.
 * @throws Error if the browser gives no canvas to draw on.
 */
export function pixelsOf(picture: HTMLImageElement, name: string): Uint8ClampedArray {
  const { width, height } = picture
  const canvas = document.createElement('canvas')
  canvas.width = width
  canvas.height = height
  const context = canvas.getContext('2d', { willReadFrequently: true })
  if (context === null) throw new Error(`${name}: there is no 2D canvas`)
  context.scale(1, -1)
  context.drawImage(picture, 0, -height)
  return context.getImageData(0, 0, width, height).data
}
