import type { RenderTarget, Vector2 } from 'three'
import { uv, vec2 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import type { FragmentPass } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { SharedRows } from './AirOccluder'

/** Width of tiles side by side, at most [texels]. */
const MOST_WIDTH = 1056

/** Tiles side by side in a texture, each with a texel for every ray of a grid: one for each slice of the rays, say. */
export class RayTiles {
  /** Rows of another texture that they lie in; undefined for a texture of their own. */
  room: SharedRows | undefined
  readonly #own: RenderTarget
  readonly #count: number
  readonly #mostColumns: number
  /** Rays in each direction. */
  readonly #grid = vector2()
  /** Size of all tiles, and first row [texels]. */
  readonly #size = vector2()
  readonly #first = number()
  readonly #columns = number(1)
  /** Size of a texel in texture coordinates. */
  readonly #texelSize = vector2()

  /**
   * @param own - Texture of their own.
   * @param count - Number of tiles.
   * @param mostColumns - Most tiles in a row.
   */
  constructor(own: RenderTarget, count: number, mostColumns: number) {
    this.#own = own
    this.#count = count
    this.#mostColumns = mostColumns
  }

  /** The texture in which they are now. */
  get target(): RenderTarget {
    return this.room?.target ?? this.#own
  }

  /**
   * Lays them out.
   *
   * @param grid - Rays in each direction.
   * @returns False if so many have no room.
   */
  resize(grid: Vector2): boolean {
    const { room, target } = this
    const columns = Math.min(Math.floor(MOST_WIDTH / grid.x), this.#mostColumns)
    const size = this.#size.value.copy(grid)
    size.x *= columns
    size.y *= Math.ceil(this.#count / columns)
    if (target === this.#own) target.setSize(size.x, size.y)
    else if (size.y > room!.count) return false
    else this.#own.dispose()
    this.#first.value = target === this.#own ? 0 : room!.first
    this.#columns.value = columns
    this.#grid.value.copy(grid)
    this.#texelSize.value.set(1 / target.width, 1 / target.height)
    return true
  }

  /** Fills all of them, by a pass for whose texels {@link texel} tells what they are. */
  render(renderer: Renderer, pass: FragmentPass): void {
    const { target } = this
    const { x, y } = this.#size.value
    for (const box of [target.viewport, target.scissor]) box.set(0, this.#first.value, x, y)
    target.scissorTest = true
    pass.render(renderer, target)
  }

  /** Number of the tile that a pass draws to, and place in it [texels]. */
  texel(): { tile: Float; place: Vec2 } {
    const texel = uv().mul(this.#size).floor().toConst() as unknown as Vec2
    const at = texel.div(this.#grid).add(1e-4).floor().toConst() as Vec2
    const tile = at.y.mul(this.#columns).add(at.x).toConst() as Float
    return { tile, place: texel.sub(at.mul(this.#grid)).toConst() }
  }

  /**
   * Reads a tile, bilinearly.
   *
   * @param source - Their texture: a target may have several.
   * @param place - Place in the tile, half a number in the middle of a texel [texels].
   */
  read(source: TextureNode, tile: Float, place: Vec2): Vec4 {
    const row = tile.add(0.5).div(this.#columns).floor().toConst() as Float
    const at = vec2(tile.sub(row.mul(this.#columns)), row).mul(this.#grid)
    const texel = at.add(place).add(vec2(0, this.#first))
    return sampleLevel0(source, texel.mul(this.#texelSize)).toConst()
  }

  /** Frees their own texture. */
  dispose(): void {
    this.#own.dispose()
  }
}
