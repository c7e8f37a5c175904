import type { Vector2 } from 'three'
import { Fn, If, float, texture, uv, vec2, vec4 } from 'three/tsl'
import type { Renderer, TextureNode, UniformNode } from 'three/webgpu'
import { FragmentPass, tableTarget } from '../tables/FragmentPass'
import { sampleLevel0, type Float, type Vec2, type Vec4 } from '../tsl-types'

/**
 * Octaves of depth by which pixels may differ and still share light, and by which they share none. Greater: halos at
 * silhouettes; smaller: the march's pixels show on slopes (*Towers in haze*).
 */
const SAME_DEPTH = 0.35
const OTHER_DEPTH = 0.8

/** Least weight in the bilateral upsampling: that of pixels of another depth. */
const MIN_WEIGHT = 1e-3

/** A grid of pixels: in the left half light, in the right one log₂ of the distance, the least and the greatest one around, and lit air. */
export interface PixelGrid {
  readonly texels: TextureNode
  /** Size of either half [texels]. */
  readonly size: UniformNode<'vec2', Vector2>
  /** Texel of both in texture coordinates. */
  readonly texelSize: UniformNode<'vec2', Vector2>
}

/**
 * Light of a grid of pixels for those between them: by depth, and smooth where that is about the same. Sums of four are
 * made beforehand, so that a pixel has two reads in place of nine.
 */
export class ShaftUpsampling {
  /** At the corners of the grid's texels: in the left half the mean light of the four, in the right one their distances. */
  readonly #target = tableTarget('Welkin.LightShafts.corners', 1, 1)
  readonly #corners: TextureNode = texture(this.#target.texture)
  readonly #grid: PixelGrid
  #pass: FragmentPass | null = null

  constructor(grid: PixelGrid) {
    this.#grid = grid
  }

  /** Follows the size of the grid. */
  resize(): void {
    const { x, y } = this.#grid.size.value
    this.#target.setSize(2 * x + 2, y + 1)
  }

  /** Draws what pixels read, once the grid is drawn. */
  draw(renderer: Renderer): void {
    this.#pass ??= new FragmentPass('Welkin.LightShafts.corners', this.#corner())
    this.#pass.render(renderer, this.#target)
  }

  #read(texel: Vec2): Vec4 {
    return sampleLevel0(this.#grid.texels, texel.mul(this.#grid.texelSize)).toConst()
  }

  /** Reads the corners, counted from 0; either half at any place between them. */
  #readCorner(corner: Vec2, half: 0 | 1): Vec4 {
    const corners = this.#grid.size.add(1).toConst() as Vec2
    const inHalf = corner.min(corners.sub(1)).add(0.5)
    const at = inHalf.add(vec2(corners.x.mul(half), 0)).div(vec2(corners.x.mul(2), corners.y))
    return sampleLevel0(this.#corners, at).toConst()
  }

  /** A texel of the corners. */
  #corner(): Vec4 {
    const { size } = this.#grid
    return Fn((): Vec4 => {
      const corners = size.add(1).toConst() as Vec2
      const corner = uv()
        .mul(vec2(corners.x.mul(2), corners.y))
        .floor()
        .toVar() as Vec2
      const result = vec4(0).toVar()
      If(corner.x.lessThan(corners.x), () => {
        // Bilinear reads have the mean at once, and not that of the other half.
        result.assign(this.#read(corner.min(vec2(size.x.sub(0.5), size.y))))
      }).Else(() => {
        corner.x.subAssign(corners.x)
        const distances = this.#around(corner.sub(1)).map(at => this.#distances(at).x)
        result.assign(vec4(distances[0], distances[1], distances[2], distances[3]))
      })
      return result
    })()
  }

  /** Middles of four texels of the grid that touch. */
  #around(first: Vec2): Vec2[] {
    return [0, 1, 2, 3].map(
      i =>
        first
          .add(vec2(i % 2, i >> 1))
          .clamp(vec2(0), this.#grid.size.sub(1))
          .add(0.5)
          .toConst() as Vec2
    )
  }

  /** Distances at a texel of the grid, and lit air. */
  #distances(middle: Vec2): Vec4 {
    return this.#read(middle.add(vec2(this.#grid.size.x, 0)))
  }

  /**
   * Light at a pixel: from nine around it, of which any four that touch have samples in all places of their steps;
   * where those are of several depths, from the four nearest.
   *
   * @param place - Place in the grid, counted in texels from the middle of the first.
   * @param own - log₂ of the pixel's distance.
   * @param litAir - Its lit air: asked for where no texel is of its depth.
   */
  light(place: Vec2, own: Float, litAir: () => Float): Vec4 {
    const nearest = place.add(0.5).floor().min(this.#grid.size.sub(1)).toConst() as Vec2
    const { y: least, z: greatest } = this.#distances(nearest.add(0.5))
    const light = vec4(0).toVar()
    If(own.sub(least).max(greatest.sub(own)).lessThan(SAME_DEPTH), () => {
      light.assign(this.#readCorner(place.add(0.5), 0))
    }).Else(() => {
      const first = place.floor().toConst() as Vec2
      const apart = this.#readCorner(first.add(1), 1).sub(own).abs()
      const weights = apart
        .sub(OTHER_DEPTH)
        .div(SAME_DEPTH - OTHER_DEPTH)
        .clamp(MIN_WEIGHT, 1)
        .toVar()
      const middles = this.#around(first)
      const isAlone = weights.x.max(weights.y).max(weights.z.max(weights.w)).lessThan(1).toConst()
      const sum = weights.dot(vec4(1)).toConst()
      If(isAlone, () => {
        // Of light that others have more of, or less, the same part.
        const lit = middles.map(middle => this.#distances(middle).w)
        weights.mulAssign(vec4(litAir()).div(vec4(lit[0], lit[1], lit[2], lit[3])))
      })
      const [a, b, c, d] = middles.map(middle => this.#read(middle))
      const { x, y, z, w } = weights
      const all = a.mul(x).add(b.mul(y)).add(c.mul(z)).add(d.mul(w))
      light.assign(all.div(float(sum)))
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
