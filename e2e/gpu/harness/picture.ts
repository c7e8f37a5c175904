import { DataUtils, type RenderTarget } from 'three'
import type { WebGPURenderer } from 'three/webgpu'

/** Pixels as float32 RGBA, rows top-down on every backend. */
export class Picture {
  constructor(
    readonly width: number,
    readonly height: number,
    readonly data: Float32Array
  ) {}

  /** The RGBA values of one pixel; (0, 0) is the top left. */
  at(x: number, y: number): [number, number, number, number] {
    const i = 4 * (y * this.width + x)
    const [r, g, b, a] = this.data.subarray(i, i + 4)
    return [r, g, b, a]
  }
}

/** Numbers of a render target in float32, from the elements that a read-back returns. */
function toFloats(raw: ArrayLike<number>, isHalf: boolean, isByte: boolean): Float32Array {
  if (isHalf) return Float32Array.from(raw, half => DataUtils.fromHalfFloat(half))
  if (isByte) return Float32Array.from(raw, value => value / 255)
  return Float32Array.from(raw)
}

/** Flips rows in place. */
function flipRows(data: Float32Array, width: number, height: number): void {
  const stride = 4 * width
  for (let y = 0; y < height >> 1; y++) {
    const upper = data.subarray(y * stride, (y + 1) * stride)
    const lower = data.subarray((height - 1 - y) * stride, (height - y) * stride)
    const copy = upper.slice()
    upper.set(lower)
    lower.set(copy)
  }
}

export interface ReadOptions {
  /** Attachment of a multiple render target. */
  textureIndex?: number
  /** Layer of an array or 3D target, face of a cube. */
  layer?: number
}

/** Reads an RGBA target of float32, half or 8-bit back; a read-back comes bottom-up on WebGL2. */
export async function readPicture(
  renderer: WebGPURenderer,
  target: RenderTarget,
  { textureIndex = 0, layer = 0 }: ReadOptions = {}
): Promise<Picture> {
  const { width, height } = target
  const raw = await renderer.readRenderTargetPixelsAsync(
    target,
    0,
    0,
    width,
    height,
    textureIndex,
    layer
  )
  const isByte = raw instanceof Uint8Array || raw instanceof Uint8ClampedArray
  const data = toFloats(raw, raw instanceof Uint16Array, isByte)
  if (data.length !== 4 * width * height) {
    throw new Error(`readPicture: expected RGBA texels, got ${data.length} numbers`)
  }
  if (!('isWebGPUBackend' in renderer.backend)) flipRows(data, width, height)
  return new Picture(width, height, data)
}
