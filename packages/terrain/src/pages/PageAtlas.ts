import {
  FloatType,
  HalfFloatType,
  LinearFilter,
  NearestFilter,
  RenderTarget,
  RGBAFormat,
  RGFormat
} from 'three'
import type { PixelFormat, TextureDataType } from 'three'

/** Longest side of a texture that every device has [texels]. */
const LONGEST = 8192

/** Bytes of a texel: two float32 of the vertices' texture, four float16 of the pixels'. */
const TEXEL_BYTES = 8

/** Texels of a page per cell of its tile, for pixels: a texel is two to four pixels wide at 1080 lines from a resolution of 32 on. */
const densityOf = (resolution: number): number => (resolution > 32 ? 2 : 4)

/** Fewest pages: the six faces, and a tile with all that it is a part of, several times over. */
export const LEAST_PAGES = 64

function target(name: string, side: number, type: TextureDataType): RenderTarget {
  const isFloat = type === FloatType
  const filter = isFloat ? NearestFilter : LinearFilter
  const made = new RenderTarget(side, side, {
    type,
    format: (isFloat ? RGFormat : RGBAFormat) as PixelFormat,
    depthBuffer: false,
    minFilter: filter as typeof NearestFilter,
    magFilter: filter as typeof NearestFilter
  })
  made.texture.name = name
  made.scissorTest = true
  return made
}

/** Bytes of a page. */
export const bytesOfPage = (resolution: number): number =>
  TEXEL_BYTES * ((resolution + 1) ** 2 + (densityOf(resolution) * resolution + 1) ** 2)

/** Two textures with a fixed number of pages: a tile's heights for vertices, and slopes and patches for pixels. */
export class PageAtlas {
  /** Number of pages that there is room for. */
  readonly capacity: number
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

  /**
   * @param resolution - Cells along a tile's edge.
   * @param bytes - Most memory that both may take; they take that of `LEAST_PAGES` at least.
   */
  constructor(resolution: number, bytes: number) {
    this.heightSide = resolution + 1
    this.density = densityOf(resolution)
    this.surfaceSide = this.density * resolution + 1
    const most = Math.floor(LONGEST / this.surfaceSide)
    const wanted = Math.max(Math.floor(bytes / bytesOfPage(resolution)), LEAST_PAGES)
    this.columns = Math.min(Math.floor(Math.sqrt(wanted)), most)
    this.capacity = this.columns ** 2
    this.heights = target('Welkin.Terrain.heights', this.columns * this.heightSide, FloatType)
    this.surface = target('Welkin.Terrain.surface', this.columns * this.surfaceSide, HalfFloatType)
  }

  /** Memory on the GPU [bytes]. */
  get bytes(): number {
    return TEXEL_BYTES * (this.heights.width ** 2 + this.surface.width ** 2)
  }

  /** Has the next drawing go to a page alone. */
  aim(drawn: RenderTarget, slot: number): void {
    const side = drawn.width / this.columns
    const x = (slot % this.columns) * side
    const y = Math.floor(slot / this.columns) * side
    for (const box of [drawn.viewport, drawn.scissor]) box.set(x, y, side, side)
  }

  dispose(): void {
    this.heights.dispose()
    this.surface.dispose()
  }
}
