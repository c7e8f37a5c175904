import { vec2 } from 'three/tsl'
import type { LevelTexture, Vec2, Vec4 } from '../../tsl-types'

/**
 * Light of a history between its pixels, by cubic convolution, of which five bilinear reads are taken: bilinear
 * ones alone, frame after frame, would blur what moves.
 *
 * @param at - Place in the picture [pixels].
 * @param size - Size of the picture [pixels].
 * @see Keys 1981, "Cubic convolution interpolation for digital image processing", IEEE TASSP 29 (6), "The cubic
 * convolution interpolation kernel", p. 1155, a = −½
 */
export function sharpSample(light: LevelTexture<Vec2>, at: Vec2, size: Vec2): Vec4 {
  const middle = at.sub(0.5).floor().add(0.5).toConst() as Vec2
  const f = at.sub(middle).toConst() as Vec2
  const square = f.mul(f).toConst() as Vec2
  const before = square.mul(f.mul(-0.5).add(1)).sub(f.mul(0.5)).toConst() as Vec2
  const first = square.mul(f.mul(1.5).sub(2.5)).add(1).toConst() as Vec2
  const after = square.mul(f.mul(0.5).sub(0.5)).toConst() as Vec2
  const second = first.add(before).add(after).oneMinus().toConst() as Vec2
  const inner = first.add(second).toConst() as Vec2
  const between = middle.add(second.div(inner)).toConst() as Vec2
  const [start, end] = [middle.sub(1), middle.add(2)]
  // Both axes' corrections of a bilinear look-up are added, not multiplied: of five reads their product would lack the corners, and grow
  // some details a little in each frame, without end while one turns.
  return [
    [between.x, between.y, inner.x.add(inner.y).sub(1)],
    [start.x, between.y, before.x],
    [end.x, between.y, after.x],
    [between.x, start.y, before.y],
    [between.x, end.y, after.y]
  ]
    .map(([x, y, weight]) => light.sample(vec2(x, y).div(size)).level(0).mul(weight))
    .reduce((sum, each) => sum.add(each))
    .max(0)
    .toConst()
}
