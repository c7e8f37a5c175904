import {
  DataTexture,
  LinearFilter,
  LinearMipmapLinearFilter,
  RepeatWrapping,
  RGBAFormat,
  type PixelFormat
} from 'three'

/** A texture that is smooth near and far: linear between texels, with mipmaps. @param bytes - Texels, row by row. */
export function mipmapped(
  bytes: Uint8Array,
  width: number,
  height: number,
  format: PixelFormat = RGBAFormat
): DataTexture {
  const result = new DataTexture(bytes, width, height, format)
  result.magFilter = LinearFilter
  result.minFilter = LinearMipmapLinearFilter
  result.generateMipmaps = true
  result.needsUpdate = true
  return result
}

/** A square one that repeats. @param side - Texels along an edge. */
export function tileable(bytes: Uint8Array, side: number, format?: PixelFormat): DataTexture {
  const result = mipmapped(bytes, side, side, format)
  result.wrapS = result.wrapT = RepeatWrapping
  return result
}
