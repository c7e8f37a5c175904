import { DataTexture, FloatType, NearestFilter, RedFormat, Vector3 } from 'three'
import { FragmentPass } from '@welkin/atmosphere'
import { uniform } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { HeightSource } from '../heights/HeightSource'
import { REFERENCE_STEP } from '../noise/tsl/latticeNoise'
import { faceAxes } from '../tiles/cpu/cubeSphere'
import { cubeToFigure, isFlat, type Figure } from '../tiles/cpu/figure'
import type { Tile } from '../tiles/Tile'
import { ellipsoidInShader, planeInShader } from '../tiles/tsl/figure'
import type { PageAtlas } from './PageAtlas'
import { isPageSource, type PageRequest, type PageSource } from './PageSource'
import {
  heightsOf,
  imageOf,
  loadedHeightsOf,
  loadedSurfaceOf,
  surfaceOf,
  type PageUniforms
} from './tsl/pageOutput'

const reference = new Vector3()

/** Largest step between heights of a page with so many steps along an edge [m]. */
export const spacingOf = ({ extent }: Tile, { maximumRadius }: Figure, steps: number): number =>
  (2 * extent * maximumRadius) / steps

/** Draws pages, in two passes each. */
export class PageBaker {
  readonly #tile = {
    cube: uniform(new Vector3()),
    face: uniform(0),
    extent: uniform(0),
    reference: uniform(new Vector3()),
    center: uniform(new Vector3()),
    shortest: uniform(0),
    radii: uniform(new Vector3()),
    seed: uniform(0)
  }
  readonly #heights: FragmentPass
  readonly #surface: FragmentPass
  /** Heights that were loaded, of one page; null if they come from a function. */
  readonly #loaded: DataTexture | null = null
  /** Colours of one page, and the pass that draws them; null without pictures. */
  readonly #image: { texture: DataTexture; pass: FragmentPass } | null = null

  constructor(
    readonly source: HeightSource | PageSource,
    readonly figure: Figure,
    readonly atlas: PageAtlas,
    /** Cells along a tile's edge. */
    readonly resolution: number
  ) {
    this.#tile.radii.value.copy(figure.radii)
    this.#tile.seed.value = source.seed ?? 0
    const { heightSide, surfaceSide, density } = atlas
    const shape = isFlat(figure) ? planeInShader : ellipsoidInShader
    const tile = { ...this.#tile, figure: shape } as unknown as PageUniforms
    const pass = (name: string, output: ReturnType<typeof heightsOf>): FragmentPass =>
      new FragmentPass(`Welkin.Terrain.${name}`, output)
    const side = surfaceSide + 2
    if (atlas.images !== null) {
      const texture = new DataTexture(new Uint8ClampedArray(4 * side ** 2), side, side)
      texture.name = 'Welkin.Terrain.image'
      this.#image = { texture, pass: pass('images', imageOf(texture, surfaceSide)) }
    }
    if (isPageSource(source)) {
      const texture = new DataTexture(new Float32Array(side ** 2), side, side, RedFormat, FloatType)
      texture.name = 'Welkin.Terrain.loaded'
      texture.minFilter = texture.magFilter = NearestFilter
      this.#loaded = texture
      this.#heights = pass('heights', loadedHeightsOf(texture, tile, heightSide, density))
      this.#surface = pass('surface', loadedSurfaceOf(texture, tile, surfaceSide, density))
    } else {
      this.#heights = pass('heights', heightsOf(source, tile, heightSide))
      this.#surface = pass('surface', surfaceOf(source, tile, surfaceSide, density))
    }
  }

  /** Heights to load for a tile. */
  request(tile: Tile): PageRequest {
    const steps = this.atlas.density * this.resolution
    const { face, level, x, y, extent } = tile
    const { first, second } = faceAxes(face)
    const { figure } = this
    return {
      face,
      level,
      x,
      y,
      side: steps + 3,
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
   * Draws a page; the renderer is left as it was.
   *
   * @param heights - Loaded heights, as many as `request` asked for; null for a source that is a function.
   */
  bake(renderer: Renderer, tile: Tile, slot: number, heights: Float32Array | null = null): void {
    const { atlas } = this
    if (this.#loaded !== null && heights !== null) {
      ;(this.#loaded.image.data as Float32Array).set(heights)
      this.#loaded.needsUpdate = true
    }
    const uniforms = this.#tile
    uniforms.cube.value.copy(tile.cube)
    uniforms.face.value = tile.face
    uniforms.extent.value = tile.extent
    reference.copy(tile.center).divideScalar(REFERENCE_STEP).round()
    uniforms.reference.value.copy(reference)
    uniforms.center.value.copy(tile.center).addScaledVector(reference, -REFERENCE_STEP)
    uniforms.shortest.value = 2 * spacingOf(tile, this.figure, this.resolution)
    for (const [pass, target] of [
      [this.#heights, atlas.heights],
      [this.#surface, atlas.surface]
    ] as const) {
      atlas.aim(target, slot)
      pass.render(renderer, target)
    }
  }

  /** Draws the colours of a page, as many as `request` asks heights for; the renderer is left as it was. */
  bakeImage(renderer: Renderer, slot: number, colors: Uint8ClampedArray): void {
    const { texture, pass } = this.#image!
    ;(texture.image.data as Uint8ClampedArray).set(colors)
    texture.needsUpdate = true
    this.atlas.aim(this.atlas.images!, slot)
    pass.render(renderer, this.atlas.images!)
  }

  dispose(): void {
    this.#image?.pass.dispose()
    this.#image?.texture.dispose()
    this.#heights.dispose()
    this.#surface.dispose()
    this.#loaded?.dispose()
  }
}
