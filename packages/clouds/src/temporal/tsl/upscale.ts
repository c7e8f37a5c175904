import { Fn, If, exp2, float, int, mix, smoothstep, uv, vec2, vec4 } from 'three/tsl'
import {
  fromBits,
  toBits,
  twoOutputs,
  type Float,
  type Mat3,
  type TwoOutputs,
  type Vec2,
  type Vec3,
  type Vec4
} from '../../tsl-types'
import { isClear, type Cell } from './cells'
import { cellPlace, estimate, type Estimate } from './estimate'
import { interleavedNoise } from './noisePattern'
import {
  brightness,
  CLEAR,
  encodeDistance,
  FARTHEST,
  fits,
  known,
  pack,
  SAME,
  unpack,
  type CloudPictures
} from './pictures'
import { viewRayAt, viewRayEnd, type ViewRay, type ViewRayNodes } from '../../march/tsl/viewRay'

/** Looks of pixels that were marched themselves. */
const OWN_LOOK = 0.5

/** Moves within a frame that are taken as none, so that nothing blurs [pixels]. */
const STANDING = 0.02

/** Moves within a frame after which history is no more than a stopgap, and what it counts then [pixels, looks]. */
const FAST = 10
const LEAST_MEMORY = 0.1

/**
 * What history may differ from its surroundings besides: what is smaller than a block is not seen in
 * every frame, and is kept while the picture hardly moves, with things in the same places. Not what has been seen in too few looks: it may
 * be left over from a move.
 */
const STANDING_SLACK = 1
const MOVING_SLACK = 0.01
const YOUNG_LOOKS = 1.5
const OLD_LOOKS = 4

/** Error of the reprojection at which history is forgotten [pixels]. */
const PARALLAX = 4

/** Digits of a float's mantissa that a half float lacks. */
const SPARE_DIGITS = 13

/**
 * Rounds to half floats, up or down as often as is right in the mean: GPUs cut digits off, frame by frame.
 *
 * @param value - At least 0.
 * @param noise - In [0, 1).
 */
function toHalf(value: Vec4, noise: Float): Vec4 {
  const carry = int(noise.mul(2 ** SPARE_DIGITS))
  return fromBits(
    toBits(value)
      .add(carry)
      .bitAnd(int(-(2 ** SPARE_DIGITS)))
  )
}

/**
 * What the last frame had where the clouds of a pixel were, and how many looks it is worth; and 1 where
 * nothing moved, neither the clouds nor what was drawn, or less, to 0.
 */
function remembered(
  { frame }: ViewRayNodes,
  history: CloudPictures,
  pixel: Vec2,
  { ndc, length }: ViewRay,
  end: Float,
  distance: Float,
  origin: Vec3
): { light: Vec4; weight: Float; sameness: Float } {
  const raysBefore = frame.raysBefore as unknown as Mat3
  const clipped = raysBefore
    .mul(ndc)
    .add(origin.mul(length.div(exp2(distance))))
    .toConst() as Vec3
  const spot = clipped.xy.div(clipped.z.max(1e-9)).mul(vec2(0.5, -0.5)).add(0.5)
  const moved = spot.mul(frame.size).sub(0.5).sub(pixel).toConst() as Vec2
  const isStanding = moved.x.abs().max(moved.y.abs()).lessThan(STANDING)
  const from = pixel
    .add(isStanding.select(vec2(0), moved))
    .add(0.5)
    .toConst() as Vec2
  const isInside = from.clamp(vec2(0), frame.size).equal(from).all().and(clipped.z.greaterThan(0))
  const nearest = from.floor().add(0.5).div(frame.size)
  const about = unpack(history.place.sample(nearest).level(0))
  const seen = known(end).toConst() as Float
  const light = history.light.sample(from.div(frame.size)).level(0).toConst() as Vec4
  // How far off clouds at that distance are from where those of this one were.
  const ratio = exp2(distance.sub(about.x)).sub(1).abs()
  const way = moved.length().toConst() as Float
  const parallax = ratio.mul(way).div(PARALLAX).oneMinus().clamp()
  const valid = isInside.select(fits(seen, about), 0).mul(parallax)
  const { gainChange } = frame
  return {
    light: light.mul(vec4(gainChange, gainChange, gainChange, 1)).toConst(),
    sameness: seen.sub(about.y).abs().lessThan(SAME).select(way.oneMinus().max(0), 0),
    weight: about.z
      .abs()
      .min(frame.memory.mul(way.div(FAST).oneMinus()).max(LEAST_MEMORY))
      .mul(valid)
      .toConst()
  }
}

/** Moves light towards the mean of what is around until it is not too far from there. */
function clip(light: Vec4, { mean, around }: Estimate, deviations: Float, slack: Float): Vec4 {
  const clipped = light.toVar() as Vec4
  const difference = vec2(brightness(light), light.w).sub(around.xy).abs()
  const excess = difference.div(around.zw.mul(deviations).add(slack)).toConst() as Vec2
  const most = excess.x.max(excess.y).toConst() as Float
  If(most.greaterThan(1), () => {
    clipped.assign(mix(mean(), light, most.reciprocal()))
  })
  return clipped
}

/**
 * Clouds in full resolution, from those marched in this frame and those of the last one: these are looked
 * up where the clouds were, clipped towards what this frame has nearby, and left out where something
 * else was seen.
 *
 * Looks are stored with a minus sign where there is no cloud.
 *
 * @param cells - From `gatherCells`.
 * @see Karis 2014, "High quality temporal supersampling"; Salvi 2016 on variance clipping
 */
export function upscale(
  sights: ViewRayNodes,
  marched: CloudPictures,
  cells: CloudPictures,
  history: CloudPictures
): TwoOutputs {
  const { frame } = sights
  return twoOutputs(([light, place]) =>
    Fn(() => {
      const pixel = uv().mul(frame.size).floor().toConst() as unknown as Vec2
      const middle = pixel.add(0.5).div(frame.size).toConst() as Vec2
      const where = cellPlace(sights, pixel)
      const cellAt = where.corner.add(1.5).div(frame.marchedSize.add(1)).toConst() as Vec2
      const cellLight = cells.light.sample(cellAt).level(0).toConst() as Vec4
      const before = vec4(0).toVar() as Vec4
      If(isClear(cellLight).and(frame.hasHistory.greaterThan(0)), () => {
        before.assign(unpack(history.place.sample(middle).level(0)))
      })
      // Clear around and clear before: one more look at nothing.
      const looks = before.z.sub(frame.block.mul(frame.block).reciprocal())
      light.assign(vec4(0, 0, 0, 1))
      place.assign(pack(float(FARTHEST), before.y, looks.max(frame.memory.negate())))
      If(before.z.greaterThanEqual(0), () => {
        const cell: Cell = {
          light: cellLight,
          place: cells.place.sample(cellAt).level(0).toConst()
        }
        const sight = viewRayAt(sights, middle)
        const isOpen = cell.place.z.greaterThanEqual(FARTHEST)
        const end = encodeDistance(viewRayEnd(sights, middle, sight, isOpen)).toConst() as Float
        const now = estimate(sights, marched, where, cell, end)
        const result = now.light.toVar() as Vec4
        const weight = now.look.toVar()
        If(frame.hasHistory.greaterThan(0), () => {
          const origin = frame.originArray.element(cell.place.w.toInt()).xyz
          const last = remembered(sights, history, pixel, sight, end, now.distance, origin)
          If(last.weight.greaterThan(0), () => {
            const slack = smoothstep(YOUNG_LOOKS, OLD_LOOKS, last.weight)
              .mul(last.sameness.mul(STANDING_SLACK))
              .max(MOVING_SLACK)
            const clipped = clip(last.light, now, frame.clipping, slack)
            // What is known well does not learn from marched pixels that are not its own.
            const isOwn = now.look.greaterThan(OWN_LOOK).or(last.weight.lessThan(1))
            const look = isOwn.select(now.look, 0).toConst()
            const all = last.weight.add(look).toConst()
            result.assign(mix(clipped, now.light, look.div(all)))
            weight.assign(all.min(frame.memory))
          })
        })
        const looked = result.w.greaterThan(CLEAR).select(weight.negate(), weight)
        light.assign(toHalf(result.max(0), interleavedNoise(pixel, frame.noiseShift)))
        place.assign(pack(now.distance, end, looked))
      })
      return vec4(0)
    })()
  )
}
