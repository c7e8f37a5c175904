import { DataArrayTexture, DataTexture, FloatType, RedFormat } from 'three'
import { uniform } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import { faceAxes } from '../tiles/cpu/cubeSphere'
import { cubeToFigure, isFlat, type Figure } from '../tiles/cpu/figure'
import type { Tile } from '../tiles/Tile'
import { ellipsoidInShader, planeInShader } from '../tiles/tsl/figure'
import type { PageAtlas } from './PageAtlas'
import type { FixedOptions } from '../TerrainOptions'
import type { HeightReadback } from './HeightReadback'
import { MOST, PageQuads } from './PageQuads'
import { isPageSource, type PageRequest, type PageSource } from './PageSource'
import {
  heightsOf,
  imageOf,
  loadedHeightsOf,
  loadedSurfaceOf,
  surfaceOf,
  type PageUniforms
} from './tsl/pageOutput'

/** Largest step between heights of a page with so many steps along an edge [m]. */
export const spacingOf = ({ extent }: Tile, { maximumRadius }: Figure, steps: number): number =>
  (2 * extent * maximumRadius) / steps

/** Draws pages, many at once, in two passes. */
export class PageBaker {
  readonly #quads: PageQuads
  /** Cells along a tile's edge. */
  readonly #resolution: number
  /** Read-back of heights to the CPU; null if nobody asks for them. */
  readonly #readback: HeightReadback | null
  /** Heights that were loaded, a page to a layer; null if they come from a function. */
  readonly #loaded: DataArrayTexture | null = null
  /** Colours of one page, and what draws them; null without pictures. */
  readonly #image: { texture: DataTexture; quads: PageQuads } | null = null

  constructor(
    readonly source: HeightSource | PageSource,
    readonly figure: Figure,
    readonly atlas: PageAtlas,
    { resolution, horizon }: FixedOptions
  ) {
    this.#resolution = resolution
    const { heights, surface, heightSide, surfaceSide, density } = atlas
    const quads = (this.#quads = new PageQuads(atlas))
    const tile = {
      ...quads.tile,
      radii: uniform(figure.radii),
      seed: uniform(source.seed ?? 0),
      figure: isFlat(figure) ? planeInShader : ellipsoidInShader
    } as PageUniforms
    const side = surfaceSide + 2
    if (atlas.images !== null) {
      const texture = new DataTexture(new Uint8ClampedArray(4 * side ** 2), side, side)
      texture.name = 'Welkin.Terrain.image'
      const images = new PageQuads(atlas)
      images.addPass('images', imageOf(texture, surfaceSide), atlas.images)
      this.#image = { texture, quads: images }
    }
    if (isPageSource(source)) {
      // Below the heights are the vertices' shares of the sky.
      const rows = side + Math.ceil(heightSide ** 2 / side)
      const data = new Float32Array(MOST * side * rows)
      const texture = new DataArrayTexture(data, side, rows, MOST)
      texture.name = 'Welkin.Terrain.loaded'
      texture.format = RedFormat
      texture.type = FloatType
      this.#loaded = texture
      quads.addPass('heights', loadedHeightsOf(texture, tile, heightSide, density), heights)
      quads.addPass('surface', loadedSurfaceOf(texture, tile, surfaceSide, density), surface)
    } else {
      quads.addPass('heights', heightsOf(source, tile, heightSide), heights)
      quads.addPass('surface', surfaceOf(source, tile, surfaceSide, density), surface)
    }
    const readback = (this.#readback = horizon?.readback(atlas, MOST) ?? null)
    if (readback !== null)
      quads.addPass('readback', readback.output, readback.target, readback.place)
  }

  /** Heights to load for a tile. */
  request(tile: Tile): PageRequest {
    const steps = this.atlas.density * this.#resolution
    const { face, level, x, y, extent } = tile
    const { first, second } = faceAxes(face)
    const { figure } = this
    return {
      face,
      level,
      x,
      y,
      side: steps + 3,
      vertices: this.#resolution + 1,
      spacing: spacingOf(tile, figure, steps),
      placeOf(column, row, target) {
        const across = ((2 * (column - 1)) / steps - 1) * extent
        const along = ((2 * (row - 1)) / steps - 1) * extent
        target.copy(tile.cube).addScaledVector(first, across).addScaledVector(second, along)
        return cubeToFigure(target, figure, target)
      }
    }
  }

  /**
   * Draws a page by the next {@link flush}; the renderer is left as it was.
   *
   * @param heights - Answer of the source to `request`; null for a source that is a function.
   */
  bake(renderer: Renderer, tile: Tile, slot: number, heights: Float32Array | null = null): void {
    const row = this.#quads.add(tile, slot, 2 * spacingOf(tile, this.figure, this.#resolution))
    this.#readback?.add(tile)
    const loaded = this.#loaded
    if (loaded !== null && heights !== null) {
      const { data, width, height } = loaded.image
      const first = row * width * height
      // All of the sky is seen where nothing else is known.
      data!.fill(1, first + width ** 2, first + width * height).set(heights, first)
      loaded.addLayerUpdate(row)
      loaded.needsUpdate = true
    }
    if (row + 1 === MOST) this.flush(renderer)
  }

  /** Draws the pages that wait; with a read-back their tiles have the heights some frames later. */
  flush(renderer: Renderer): void {
    this.#quads.draw(renderer)
    this.#readback?.read(renderer)
  }

  /** Draws the colours of a page, as many as `request` asks heights for; the renderer is left as it was. */
  bakeImage(renderer: Renderer, tile: Tile, slot: number, colors: Uint8ClampedArray): void {
    const { texture, quads } = this.#image!
    ;(texture.image.data as Uint8ClampedArray).set(colors)
    texture.needsUpdate = true
    quads.add(tile, slot, 0)
    quads.draw(renderer)
  }

  dispose(): void {
    this.#image?.quads.dispose()
    this.#image?.texture.dispose()
    this.#quads.dispose()
    this.#readback?.dispose()
    this.#loaded?.dispose()
  }
}
