import {
  Break,
  float,
  Fn,
  If,
  int,
  Loop,
  max,
  min,
  smoothstep,
  textureSize,
  uv,
  vec2,
  vec3
} from 'three/tsl'
import { Node } from 'three/webgpu'
import type { TextureNode } from 'three/webgpu'

/** Contrast from which neighbours are an edge: absolute, and over the brighter, in the display's values. */
const EDGE = [0.03, 0.06] as const

/** Places along an edge at which its end is looked for each way, a pixel apart and then by this part of the distance. */
const STEPS = 8
const GROWTH = 0.33

/** Product of the differences to both sides, over the squared contrast, from which a pixel is thin. */
const THIN = 0.05

type Float = Node<'float'>
type Vec2 = Node<'vec2'>
type Vec4 = Node<'vec4'>
type Variable = Vec4 & { assign(value: Vec4): void }

/** Smooths stairs along edges: see {@link smoothEdges}. */
export class SmoothEdgesNode extends Node<'vec4'> {
  static get type(): string {
    return 'SmoothEdgesNode'
  }

  /** @param picture - Colours of the display, filtered linearly. */
  constructor(readonly picture: TextureNode) {
    super('vec4')
  }

  override setup(): Node {
    return smoothed(this.picture)
  }
}

/**
 * Smooths stairs along edges: FXAA that leaves what is a pixel thin, such as stars and rain, as it is.
 *
 * @param picture - Colours of the display, filtered linearly.
 * @see Lottes 2009, "FXAA" (edge search)
 */
export const smoothEdges = (picture: TextureNode): SmoothEdgesNode => new SmoothEdgesNode(picture)

function smoothed(picture: TextureNode): Vec4 {
  const read = (place: Vec2): Vec4 => picture.sample(place).level(float(0))
  const lightOf = ({ rgb }: Vec4): Float => rgb.dot(vec3(0.299, 0.587, 0.114)).toConst()
  const lightAt = (place: Vec2): Float => lightOf(read(place))
  return Fn(() => {
    const here = uv().toConst()
    const texel = vec2(textureSize(picture, int(0)) as unknown as Vec2)
      .reciprocal()
      .toConst()
    const beside = (x: number, y: number): Float => lightAt(here.add(texel.mul(vec2(x, y))))
    const color = read(here).toVar() as Variable
    const middle = lightOf(color)
    const [north, south, west, east] = [beside(0, -1), beside(0, 1), beside(-1, 0), beside(1, 0)]
    const highest = max(middle, north, south, west, east).toConst()
    const lowest = min(middle, north, south, west, east)
    const contrast = highest.sub(lowest).toConst()
    If(contrast.greaterThan(max(EDGE[0], highest.mul(EDGE[1]))), () => {
      const [nw, ne, sw, se] = [beside(-1, -1), beside(1, -1), beside(-1, 1), beside(1, 1)]
      const bend = (a: Float, b: Float, c: Float): Float => a.add(c).sub(b.mul(2)).abs()
      const acrossRows = bend(north, middle, south)
        .mul(2)
        .add(bend(nw, west, sw))
        .add(bend(ne, east, se))
      const acrossColumns = bend(west, middle, east)
        .mul(2)
        .add(bend(nw, north, ne))
        .add(bend(sw, south, se))
      const isRow = acrossRows.greaterThanEqual(acrossColumns).toConst()
      const before = isRow.select(north, west).toConst()
      const after = isRow.select(south, east).toConst()
      const isBefore = before.sub(middle).abs().greaterThan(after.sub(middle).abs()).toConst()
      const other = isBefore.select(before, after).toConst()
      const step = vec2(isRow.select(vec2(0, texel.y), vec2(texel.x, 0)) as Vec2)
      const across = isBefore.select(step.negate(), step).toConst() as Vec2
      const along = vec2(isRow.select(vec2(texel.x, 0), vec2(0, texel.y)) as Vec2).toConst()
      const edge = middle.add(other).mul(0.5).toConst()
      const end = other.sub(middle).abs().mul(0.25).toConst()
      const start = here.add(across.mul(0.5)).toConst()
      /** Distance to the end of the edge [pixels], and light there over that of the edge. */
      const walk = (sign: number): Vec2 => {
        const found = vec2(1, 0).toVar()
        Loop(STEPS, () => {
          found.y.assign(lightAt(start.add(along.mul(found.x.mul(sign)))).sub(edge))
          If(found.y.abs().greaterThanEqual(end), () => {
            Break()
          })
          found.x.addAssign(max(found.x.mul(GROWTH), 1))
        })
        return found
      }
      const [back, on] = [walk(-1), walk(1)]
      const near = vec2(back.x.lessThan(on.x).select(back, on) as Vec2).toConst()
      // On the side of the pixel's own light the edge stays where it is.
      const isOther = near.y.mul(middle.sub(edge)).lessThan(0)
      const part = float(0.5).sub(near.x.div(back.x.add(on.x)))
      // Corners of steep stairs.
      const around = north.add(south).add(west).add(east).mul(2).add(nw).add(ne).add(sw).add(se)
      const unlike = around.div(12).sub(middle).abs().div(contrast).min(1)
      const corner = smoothstep(0, 1, unlike).pow(2)
      const isThin = before
        .sub(middle)
        .mul(after.sub(middle))
        .greaterThan(contrast.mul(contrast).mul(THIN))
      // What is brighter or darker than both sides is a star or a drop, not an edge.
      const moved = across.mul(isThin.select(0, max(isOther.select(part, 0), corner)))
      color.assign(read(here.add(moved)))
    })
    return color
  })()
}
