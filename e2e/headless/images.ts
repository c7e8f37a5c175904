import { PNG } from 'pngjs'

/** A browser's `Image` as far as three's effects load their tables by it: of a PNG in an address. */
class TableImage {
  width = 0
  height = 0
  data = new Uint8Array()
  onload: (() => void) | null = null

  set src(address: string) {
    const { width, height, data } = PNG.sync.read(Buffer.from(address.split(',')[1], 'base64'))
    Object.assign(this, { width, height, data })
    queueMicrotask(() => this.onload?.())
  }
}

/** Has a device take images, of which Node has none. */
export function takeImages(device: GPUDevice): void {
  const { queue } = device
  Object.assign(globalThis, { Image: TableImage })
  queue.copyExternalImageToTexture = ({ source }, destination, size) => {
    if (!(source instanceof TableImage)) throw new Error('headless: an image must be a PNG')
    const { data, width } = source as TableImage
    queue.writeTexture(destination, data, { bytesPerRow: 4 * width }, size)
  }
  // Each reading makes another object of it.
  Object.defineProperty(device, 'queue', { value: queue })
}
