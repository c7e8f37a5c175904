import { Vector2 } from 'three'
import { Fn, If, step, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'
import { vector2 } from '../uniforms'

/**
 * Octaves of depth by which pixels may differ and still share light, and by which they share none. Greater: halos at
 * silhouettes; smaller: the march's pixels show on slopes (*Towers in haze*).
 */
const SAME_DEPTH = 0.35
const OTHER_DEPTH = 0.8

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-3

const _size = new Vector2()

/** A grid of pixels: in the left half light, in the right one log₂ of the distance, the least and the greatest one around, and lit air. */
export interface PixelGrid {
  readonly texels: TextureNode
  /** Size of either half [texels]. */
  readonly size: UniformNode<'vec2', Vector2>
  /** Texel of both in texture coordinates. */
  readonly texelSize: UniformNode<'vec2', Vector2>
}

/** Blocks of the target: mean light at the corners of the grid's texels, and copies of either half of the grid. */
const BLOCKS = 3
const [MEANS, LIGHT, DISTANCES] = [0, 1, 2]

/**
 * Light of a grid of pixels for those between them: by depth, and smooth where that is about the same. Sums of four are
 * made beforehand, so that a pixel has two reads in place of five, of one texture.
 */
export class ShaftUpsampling {
  readonly #target = tableTarget('Welkin.LightShafts.blocks', 1, 1)
  readonly #blocks: TextureNode = texture(this.#target.texture)
  readonly #grid: PixelGrid
  /** Direction in which blocks follow each other: across the longer edge. */
  readonly #stack = vector2()
  #pass: FragmentPass | null = null

  constructor(grid: PixelGrid) {
    this.#grid = grid
  }

  /** Follows the size of the grid. */
  resize(): void {
    const { x, y } = this.#grid.size.value
    const isWide = x > y
    this.#stack.value.set(isWide ? 0 : 1, isWide ? 1 : 0)
    const { width, height } = _size
      .copy(this.#stack.value)
      .multiplyScalar(BLOCKS - 1)
      .addScalar(1)
    this.#target.setSize((x + 1) * width, (y + 1) * height)
  }

  /** Draws what pixels read, once the grid is drawn. */
  draw(renderer: Renderer): void {
    this.#pass ??= new FragmentPass('Welkin.LightShafts.blocks', this.#texel())
    this.#pass.render(renderer, this.#target)
  }

  /** Size of a block, one more than that of the grid, and of all of them [texels]. */
  #sizes(): { block: Vec2; all: Vec2 } {
    const block = this.#grid.size.add(1).toConst() as Vec2
    return { block, all: block.mul(this.#stack.mul(BLOCKS - 1).add(1)) }
  }

  /** A texel of the blocks. */
  #texel(): Vec4 {
    const { size, texels, texelSize } = this.#grid
    const read = (texel: Vec2): Vec4 => sampleLevel0(texels, texel.mul(texelSize)).toConst()
    return Fn((): Vec4 => {
      const { block, all } = this.#sizes()
      const at = uv().mul(all).floor().toConst() as Vec2
      const number = at.div(block).dot(this.#stack).add(1e-4).floor().toConst() as Float
      const here = at.sub(block.mul(this.#stack).mul(number)).toConst() as Vec2
      const result = vec4(0).toVar()
      If(number.lessThan(0.5), () => {
        // Bilinear reads at a corner have the mean at once, and not that of the other half.
        result.assign(read(here.min(vec2(size.x.sub(0.5), size.y))))
      }).Else(() => {
        const half = vec2(size.x.mul(number.sub(1)), 0)
        result.assign(read(here.min(size.sub(1)).add(0.5).add(half)))
      })
      return result
    })()
  }

  /** Reads a block, at a place in texels. */
  #read(block: number, place: Vec2): Vec4 {
    const { block: size, all } = this.#sizes()
    const at = place.add(size.mul(this.#stack).mul(block)).div(all)
    return sampleLevel0(this.#blocks, at).toConst()
  }

  /**
   * Light at a pixel: from nine around it, of which any four that touch have samples in all places of their steps;
   * where those are of several depths, from the four nearest.
   *
   * @param place - Place in the grid, counted in texels from the middle of the first.
   * @param own - log₂ of the pixel's distance.
   */
  light(place: Vec2, own: Float): Vec4 {
    const { size } = this.#grid
    const nearest = place.add(0.5).floor().min(size.sub(1)).toConst() as Vec2
    const { y: least, z: greatest } = this.#read(DISTANCES, nearest.add(0.5))
    const light = vec4(0).toVar()
    If(own.sub(least).max(greatest.sub(own)).lessThan(SAME_DEPTH), () => {
      light.assign(this.#read(MEANS, place.add(1).min(size.add(0.5))))
    }).Else(() => {
      const first = place.floor().toConst() as Vec2
      const middles = [0, 1, 2, 3].map(
        i =>
          first
            .add(vec2(i % 2, i >> 1))
            .clamp(vec2(0), size.sub(1))
            .add(0.5)
            .toConst() as Vec2
      )
      const [a, b, c, d] = middles.map(middle => this.#read(DISTANCES, middle))
      const apart = vec4(a.x, b.x, c.x, d.x).sub(own).abs().toConst() as Vec4
      const weights = apart
        .sub(OTHER_DEPTH)
        .div(SAME_DEPTH - OTHER_DEPTH)
        .clamp(MIN_WEIGHT, 1)
        .toConst() as Vec4
      // Of light that others have more of, or less, the same part: as much as the one nearest in depth.
      const lit = vec4(a.w, b.w, c.w, d.w).toConst() as Vec4
      const least = apart.x.min(apart.y).min(apart.z.min(apart.w))
      const isNearest = step(apart, vec4(least)).toConst() as Vec4
      const litHere = isNearest.dot(lit).div(isNearest.dot(vec4(1)))
      const parts = weights.mul(vec4(litHere).div(lit)).toConst() as Vec4
      const { x, y, z, w } = parts
      const sum = [x, y, z, w]
        .map((part, i) => this.#read(LIGHT, middles[i]).mul(part))
        .reduce((total, part) => total.add(part))
      light.assign(sum.div(weights.dot(vec4(1))))
    })
    return light
  }

  /** Frees its target, which is made again where it is drawn. */
  dispose(): void {
    this.#target.dispose()
    this.#pass?.dispose()
    this.#pass = null
  }
}
