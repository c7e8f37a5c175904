import {
  FloatType,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  RenderTarget,
  RGBAFormat,
  RGFormat,
  UnsignedByteType
} from 'three'
import type { PixelFormat, TextureDataType } from 'three'
import type { PageImages } from './PageImages'

/** Longest side of a texture that every device has [texels]. */
const LONGEST = 8192

/** Bytes of a texel: two float32 of the vertices' texture, four float16 of the pixels'. */
const TEXEL_BYTES = 8

/** Bytes of a texel of pictures. */
const IMAGE_BYTES = 4

/** Pages that a view needs where it needs the most: at eye height, with the horizon in view. */
const ENOUGH_PAGES = 1100

/** Bytes of a page, pictures left out. */
const bytesOfPage = (resolution: number, density: number): number =>
  TEXEL_BYTES * ((resolution + 1) ** 2 + (density * resolution + 1) ** 2)

/** Texels of a page along its edge, for pixels: one is two to four pixels wide at 1080 lines, as tiles are seen at a `detail` of 1.2. */
const FINEST_TEXELS = 132

/** Texels of a page per cell of its tile, for pixels: fewer where memory is short. */
function densityOf(resolution: number, bytes: number): number {
  let density = Math.max(Math.floor(FINEST_TEXELS / resolution), 1)
  while (density > 1 && bytes < ENOUGH_PAGES * bytesOfPage(resolution, density)) density >>= 1
  return density
}

/** Fewest pages: the six faces, and a tile with all that it is a part of, several times over. */
const LEAST_PAGES = 64

/** Options of a terrain that its textures depend on. */
interface AtlasOptions {
  readonly resolution: number
  readonly pageMemory: number
  readonly imagery: PageImages | null
}

/** Textures with a fixed number of pages: a tile's heights for vertices, slopes and patches for pixels, and pictures if there are any. */
export class PageAtlas {
  /** Number of pages that there is room for. */
  readonly capacity: number
  /** Memory on the GPU [bytes]. */
  readonly bytes: number
  /** Pages in a row. */
  readonly columns: number
  /** Side of a page for vertices, one texel to a vertex [texels]. */
  readonly heightSide: number
  /** Texels of a page for pixels per cell of its tile, along an edge. */
  readonly density: number
  /** Side of a page for pixels [texels]. */
  readonly surfaceSide: number
  /** Height [m] and climate, float32, for vertices. */
  readonly heights: RenderTarget
  /** Gradient along the face's two axes [–], height [m] and patchiness, float16, for pixels. */
  readonly surface: RenderTarget
  /** Colours of pictures for pixels, sRGB, RGBA of 8 bits; null without any. */
  readonly images: RenderTarget | null

  /** Textures for `pageMemory`, or for `LEAST_PAGES` if they take more. */
  constructor({ resolution, pageMemory, imagery }: AtlasOptions) {
    const bytes = 1e6 * pageMemory
    this.heightSide = resolution + 1
    this.density = densityOf(resolution, bytes)
    this.surfaceSide = this.density * resolution + 1
    const most = Math.floor(LONGEST / this.surfaceSide)
    const imageBytes = imagery === null ? 0 : IMAGE_BYTES * this.surfaceSide ** 2
    const bytesPerPage = bytesOfPage(resolution, this.density) + imageBytes
    const wanted = Math.max(Math.floor(bytes / bytesPerPage), LEAST_PAGES)
    this.columns = Math.min(Math.ceil(Math.sqrt(wanted)), most)
    const rows = Math.min(Math.floor(wanted / this.columns), most)
    this.capacity = this.columns * rows
    this.bytes = this.capacity * bytesPerPage
    const pages = (name: string, side: number, type: TextureDataType): RenderTarget => {
      const isFloat = type === FloatType
      const filter = isFloat ? NearestFilter : LinearFilter
      const target = new RenderTarget(this.columns * side, rows * side, {
        type,
        format: (isFloat ? RGFormat : RGBAFormat) as PixelFormat,
        depthBuffer: false,
        minFilter: filter as typeof NearestFilter,
        magFilter: filter as typeof NearestFilter
      })
      target.texture.name = `Welkin.Terrain.${name}`
      return target
    }
    this.heights = pages('heights', this.heightSide, FloatType)
    this.surface = pages('surface', this.surfaceSide, HalfFloatType)
    this.images = imagery && pages('images', this.surfaceSide, UnsignedByteType)
  }

  dispose(): void {
    this.heights.dispose()
    this.surface.dispose()
    this.images?.dispose()
  }
}
