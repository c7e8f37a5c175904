import { FloatType, NearestFilter, RenderTarget, RGBAFormat } from 'three'
import { Fn, attribute, float, ivec2, positionGeometry, texture, vec2, vec4 } from 'three/tsl'
import type { Renderer } from 'three/webgpu'
import type { Tile } from '../tiles/Tile'
import type { Float, Vec2, Vec4 } from '../tsl-types'
import type { PageAtlas } from './PageAtlas'

/** Texels of a row are a multiple of this: WebGPU copies rows of so many bytes. */
const ALIGNMENT = 16

/** Read-back of pages' vertex heights to the CPU: four to a texel, a page to a row. */
export class HeightReadback {
  readonly target: RenderTarget
  /** Four heights of a page. */
  readonly output: Vec4
  /** Place of a vertex of the page's row in the target, in [0, 1]. */
  readonly place: Vec2
  readonly #count: number
  /** Tiles of the pages that wait. */
  #tiles: Tile[] = []

  /** @param rows - Most pages of a drawing. */
  constructor(
    { heights, heightSide }: PageAtlas,
    readonly rows: number
  ) {
    this.#count = heightSide ** 2
    const width = ALIGNMENT * Math.ceil(this.#count / 4 / ALIGNMENT)
    this.target = new RenderTarget(width, rows, {
      type: FloatType,
      format: RGBAFormat,
      depthBuffer: false,
      minFilter: NearestFilter,
      magFilter: NearestFilter
    })
    this.target.texture.name = 'Welkin.Terrain.readback'
    const slot = attribute('pageSlot', 'vec4') as unknown as Vec4
    this.place = vec2(positionGeometry.x, slot.z.add(positionGeometry.y).div(rows))
    const atlas = texture(heights.texture) as unknown as { load(at: unknown): Vec4 }
    this.output = Fn(() => {
      const first = float(positionGeometry.x.mul(width).floor().mul(4)).toConst()
      const heightAt = (k: number): Float => {
        const i = first.add(k).min(this.#count - 1)
        const row = i.add(0.5).div(heightSide).floor().toConst()
        const texel = slot.xy.mul(heightSide).add(vec2(i.sub(row.mul(heightSide)), row))
        return atlas.load(ivec2(texel.add(0.5) as never)).x
      }
      return vec4(heightAt(0), heightAt(1), heightAt(2), heightAt(3))
    })()
  }

  /** Adds a tile whose page is in the next drawing. */
  add(tile: Tile): void {
    tile.heights = null
    this.#tiles.push(tile)
  }

  /** Reads back the pages that were drawn last: tiles that were added have their `heights` some frames later. */
  read(renderer: Renderer): void {
    const count = this.#tiles.length
    if (count === 0) return
    const pages = this.#tiles.map(tile => ({ tile, slot: tile.slot, page: ++tile.page }))
    this.#tiles = []
    const { width } = this.target
    // Rows count from the top on WebGPU, from the bottom on WebGL2.
    const isTopDown = (renderer.backend as { isWebGPUBackend?: boolean }).isWebGPUBackend === true
    const start = isTopDown ? 0 : this.rows - count
    renderer.readRenderTargetPixelsAsync(this.target, 0, start, width, count).then(
      data => {
        for (const [n, { tile, slot, page }] of pages.entries()) {
          if (slot < 0 || tile.slot !== slot || tile.page !== page) continue
          const row = 4 * width * (isTopDown ? n : count - 1 - n)
          tile.heights = (data as Float32Array).slice(row, row + this.#count)
        }
      },
      // Without its heights a tile hides nothing.
      () => undefined
    )
  }

  dispose(): void {
    this.#tiles = []
    this.target.dispose()
  }
}
