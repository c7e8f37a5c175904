import type { RenderTarget, Vector2 } from 'three'
import { uv, vec2 } from 'three/tsl'
import type { Renderer, TextureNode } from 'three/webgpu'
import type { FragmentPass } from '../tables/FragmentPass'
import { TableRegion, type TableAtlas } from '../tables/TableAtlas'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { number, vector2 } from '../uniforms'
import type { SharedRows } from './AirOccluder'

/** Width of tiles side by side, at most [texels]. */
const MOST_WIDTH = 1056

/** Tiles side by side in a texture, each with a texel for every ray of a grid: one for each slice of the rays, say. */
export class RayTiles {
  /** Rows of another texture that they lie in; undefined for a texture of their own. */
  room: SharedRows | undefined
  /** Rays in each direction. */
  readonly #grid = vector2()
  /** Columns and rows of tiles, and first row of texels. */
  readonly #tiles = vector2()
  readonly #first = number()
  /** Size of a texel in texture coordinates. */
  readonly #texelSize = vector2()

  /**
   * @param own - Texture of their own, which they free.
   * @param count - Number of tiles.
   * @param mostColumns - Most tiles in a row.
   */
  constructor(
    readonly own: RenderTarget,
    readonly count: number,
    readonly mostColumns: number
  ) {}

  /** The texture in which they are now. */
  get target(): RenderTarget {
    return this.room?.target ?? this.own
  }

  /**
   * Lays them out.
   *
   * @param grid - Rays in each direction.
   * @returns False if so many have no room.
   */
  resize(grid: Vector2): boolean {
    const { target, own, room } = this
    const isOwn = target === own
    const columns = Math.min(Math.floor(MOST_WIDTH / grid.x), this.mostColumns)
    const { x, y } = this.#tiles.value.set(columns, Math.ceil(this.count / columns))
    this.#grid.value.copy(grid)
    if (isOwn) own.setSize(grid.x * x, grid.y * y)
    else own.dispose()
    this.#first.value = isOwn ? 0 : room!.first
    this.#texelSize.value.set(1 / target.width, 1 / target.height)
    return isOwn || grid.y * y <= room!.count
  }

  /** Fills all of them, by a pass for whose texels {@link texel} tells what they are. */
  render(renderer: Renderer, pass: FragmentPass): void {
    const { x, y } = this.#tiles.value.clone().multiply(this.#grid.value)
    new TableRegion(this as unknown as TableAtlas, 0, this.#first.value, x, y).render(
      renderer,
      pass
    )
  }

  /** Number of the tile that a pass draws to, and place in it [texels]. */
  texel(): { tile: Float; place: Vec2 } {
    const cell = uv().mul(this.#tiles).toConst() as unknown as Vec2
    const at = cell.floor().toConst() as Vec2
    const place = cell.sub(at).mul(this.#grid).floor().toConst() as Vec2
    return { tile: at.y.mul(this.#tiles.x).add(at.x).toConst(), place }
  }

  /**
   * Reads a tile, bilinearly.
   *
   * @param source - Their texture: a target may have several.
   * @param place - Place in the tile, half a number in the middle of a texel [texels].
   */
  read(source: TextureNode, tile: Float, place: Vec2): Vec4 {
    const { x: columns } = this.#tiles
    const row = tile.add(0.5).div(columns).floor().toConst() as Float
    const at = vec2(tile.sub(row.mul(columns)), row)
      .mul(this.#grid)
      .add(place)
    return sampleLevel0(source, at.add(vec2(0, this.#first)).mul(this.#texelSize)).toConst()
  }

  /** Frees their own texture. */
  dispose(): void {
    this.own.dispose()
  }
}
