import { If, float, luminance, uv, vec2, vec3, vec4 } from 'three/tsl'
import type { TextureNode } from 'three/webgpu'
import {
  loop,
  sampleLevel0,
  type Bool,
  type Float,
  type Int,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { depthWeight, ROUGH, type ShownAir } from './depthWeight'
import { rarityAt, shownOf } from './rarity'

/** Octaves of depth by which pixels may differ and still share light. Smaller: the march's pixels show on slopes (*Towers in haze*). */
export const SAME_DEPTH = 0.35

/** Part of the light of air that shadows take at most where there are none to speak of. Greater: halos at silhouettes and at edges of clouds. */
const LEAST_LOST = 5e-4

/** Mark in place of a depth: next to nothing is lost [octaves]. */
export const LIT_DEPTH = 512
/** Mark that is added to a depth where light is steep: no depth is below −30 [octaves]. */
const STEEP_DEPTH = -540
/** Mark of pixels whose grounds are at different depths, less than none where light is steep, too [octaves]. */
const APART_DEPTH = 6e4

/**
 * Octaves that no depth is below, but marks of steep light are; and those that none is beyond but marks as apart, of either sign. A sixty-fourth of a
 * mark is beyond all depths, and of that for apart beyond this limit: lines a pixel wide were drawn beside marks, where they have little weight
 * (*Sun behind cumulus*, and ridges in the rain of *Valley, all day*).
 */
export const STEEP_LIMIT = -30
export const APART_LIMIT = 600

/** Octaves by which the light of rays around may differ where it is mixed. Greater: dark rings about a hidden sun in fog of droplets. */
const MIXED_OCTAVES = 0.12

/** Octaves by which it may differ at silhouettes, where light up to different depths does. Greater: dark rings there, too. */
const STEEP_OCTAVES = 0.5

/** Greatest number that the targets keep: half floats hold a little more. */
export const MAX_KEPT = 6e4

/** Greatest light that is mixed [octaves]. */
const MAX_MIXED = Math.log2(MAX_KEPT) - 4

/** Column and row in a square of so many, by number. */
export function cellOf(index: Int, columns: number): Vec2 {
  const row = float(index).div(columns).floor().toConst()
  return vec2(float(index).sub(row.mul(columns)), row).toConst()
}

/** Grid of pixels that were marched. */
interface MarchedGrid {
  /** Light that is lost, with log₂ depth; its part of the light, with log₂ of all light that there is. */
  readonly lost: TextureNode
  readonly parts: TextureNode
  /** Size [pixels], and a texel of the target in texture coordinates. */
  readonly size: Vec2
  readonly texelSize: Vec2
  /** True if pixels share what they lose with those around at their depth. */
  readonly isBlended: boolean
}

/** A texel of the second pass of light shafts: the mean of the pixels about a corner of the grid, or what a pixel loses. */
export function arrangeGrid({ lost, parts, size, texelSize, isBlended }: MarchedGrid): Vec4 {
  const texel = uv().div(texelSize).floor().toConst() as unknown as Vec2
  const result = vec4(0).toVar()
  const read = (source: TextureNode, place: Vec2): Vec4 =>
    sampleLevel0(source, place.clamp(vec2(0.5), size.sub(0.5)).div(size)).toConst()
  const row = texel.y.sub(size.y.add(1.5)).toConst() as Float
  If(row.greaterThan(0), () => {
    const isPart = row.greaterThan(size.y).toConst() as Bool
    const place = vec2(texel.x.add(0.5), row.sub(isPart.select(size.y, 0))).toConst() as Vec2
    const lossAt = (at: Vec2): Vec4 => {
      const loss = read(lost, at).toVar()
      If(isPart, () => {
        loss.assign(vec4(read(parts, at).rgb, loss.w))
      })
      return loss
    }
    const loss = lossAt(place)
    result.assign(isBlended ? vec4(blended(place, airOf(loss.w), lossAt), loss.w) : loss)
  }).Else(() => {
    // Depth, light of the air, light that is lost.
    const least = vec3(APART_DEPTH).toVar()
    const most = vec3(-APART_DEPTH).toVar()
    loop('corner', 4, index => {
      const at = texel.add(cellOf(index, 2)).sub(0.5).toConst() as Vec2
      const light = read(lost, at)
      result.addAssign(light.mul(0.25))
      const each = vec3(light.w, read(parts, at).w, luminance(light.rgb)).toConst()
      least.assign(least.min(each))
      most.assign(most.max(each))
    })
    if (isBlended) smooth(texel, result, at => read(lost, at))
    const apart = most.sub(least).toConst()
    const isEven = apart.y.lessThan(MIXED_OCTAVES).and(most.y.lessThan(MAX_MIXED))
    const isLit = most.z.max(least.z.negate()).lessThan(most.y.exp2().mul(LEAST_LOST))
    const isSteep = apart.y.greaterThan(isBlended ? MIXED_OCTAVES : STEEP_OCTAVES)
    const isAlike = apart.x.lessThan(SAME_DEPTH).toConst() as Bool
    const mark = isAlike.select(
      result.w.add(STEEP_DEPTH),
      isSteep.select(-APART_DEPTH, APART_DEPTH)
    )
    // Lit air at one depth needs no mark: at the edge of a shaft means are as good as within.
    If(isAlike.and(isEven).not(), () => {
      result.w.assign(isLit.select(LIT_DEPTH, mark))
    })
  })
  return result
}

const airOf = (depth: Float): ShownAir => ({ depth, shown: shownOf(rarityAt(depth)) })

/** Loss of a pixel and of the eight around that are as deep: places of samples count a quarter each. */
function blended(place: Vec2, own: ShownAir, lossAt: (place: Vec2) => Vec4): Vec3 {
  const sums = vec4(0).toVar()
  loop('beside', 9, index => {
    const step = cellOf(index, 3).sub(1).toConst() as Vec2
    const { rgb, w } = lossAt(place.add(step))
    const shares = step.abs().negate().add(2)
    const near = depthWeight(own, airOf(w), ROUGH)
    const weight = near.mul(near).mul(shares.x).mul(shares.y)
    sums.addAssign(vec4(rgb, 1).mul(weight))
  })
  return sums.rgb.div(sums.a)
}

/** Puts the mean of sixteen about a corner, the inner ones three times, in place of that of four, where all are at one depth: each place of samples counts a quarter. */
function smooth(texel: Vec2, mean: Vec4, lostAt: (place: Vec2) => Vec4): void {
  const light = vec3(0).toVar()
  const depths = vec2(APART_DEPTH, -APART_DEPTH).toVar()
  loop('about', 16, index => {
    const step = cellOf(index, 4).sub(1.5).toConst() as Vec2
    const { rgb, w } = lostAt(texel.add(step))
    const shares = step.abs().mul(-0.25).add(0.5).toConst() as Vec2
    light.addAssign(rgb.mul(shares.x.mul(shares.y)))
    depths.assign(vec2(depths.x.min(w), depths.y.max(w)))
  })
  If(depths.y.sub(depths.x).lessThan(SAME_DEPTH), () => {
    mean.assign(vec4(light, mean.w))
  })
}
