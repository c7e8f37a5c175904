import { Break, If, bool, float, mix, vec3 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import { sampleLayerPair } from '../../density/tsl/sampler'
import type { CloudSample } from '../../density/tsl/sample'
import { loop, type Bool, type Float, type Variable, type Vec3 } from '../../tsl-types'
import type { LayerSegment } from './layerSegment'

/** Clouds that a ray of light meets on a stretch. */
export interface StretchMoments {
  /** Optical depth, the same times place and times its square, not scaled: of what is nearest to the light, up to `MOST_COUNTED`. */
  readonly sums: Vec3
  /** Optical depth of all, not scaled. */
  readonly depth: Float
  /** Distance at which clouds begin on the side of the light; `NO_CLOUDS` if there are none [m]. */
  readonly entry: Float
}

/** Distance of the first cloud where there are none [m]. */
export const NO_CLOUDS = -1e9

/** Pairs of samples of a ray through a layer. Fewer: bands in the shadows of thin clouds under a low sun (*Shadows*). */
const PAIRS = 28

/** Even steps of a ray: those in clear air that nothing is known of, and behind what is counted. */
const EVEN_STEPS = 48

/**
 * Steps where clouds begin, as a part of even ones, and never shorter than the second [m]. Greater: shadows on tall clouds have rings
 * as wide as steps (*Storm*).
 */
const FINE_PART = 1 / 6
const FINEST = 60

/**
 * Steps through clear air, over which its strength changes by 1 [periods of the shape]. Greater: heads cast no shadows under a low sun
 * (*Storm*); smaller: rays run out of steps.
 */
const LIKELY = 0.008

/** Longest of these steps, in even ones. */
const LONGEST = 6

/** Steps in clear air longer than so many fine ones go back where they find a cloud. */
const LOOK_BACK = 1.5

/** Least part of what steps must be long for the ray to reach its end, at its start: it ends at 1. Greater: coarser near the light. */
const LEAST_PART = 0.25

/**
 * Greatest optical depth whose places count, from the side of the light on: what lies behind is dark. Greater: a head before a tower
 * casts no shadow on it (*Storm*).
 */
export const MOST_COUNTED = 100

/** Footprint of samples over a step [–]. Smaller: rings on tall clouds (*Storm*). */
const BLUR = 0.35

/**
 * Optical depth of a layer on a segment, its moments, and where it begins: a march from the side of the light, in pairs of samples
 * that share weather. Steps are long through air that is likely clear, go back from where they land in cloud, and are short
 * until its surface is known.
 *
 * @param footprint - Width of what a sample stands for at least [m].
 * @param sampleAt - The ray's sample at a distance, for a footprint [m].
 */
export function segmentMoments(
  field: CloudField,
  layer: LayerNodes,
  { front, back }: LayerSegment,
  footprint: Float,
  sampleAt: (distance: Float, footprint: Float) => CloudSample
): StretchMoments {
  const sums = vec3(0).toVar() as Vec3
  const depth = float(0).toVar()
  const entry = float(NO_CLOUDS).toVar()
  const position = front.toVar() as Float
  const even = front.sub(back).div(EVEN_STEPS).toConst() as Float
  const fine = even.mul(FINE_PART).max(even.min(FINEST)).max(footprint).toConst() as Float
  /** Length of the next steps, and true where the last two were clear. */
  const wanted = even.toVar() as Variable<Float>
  const isClear = bool(true).toVar() as Variable<Bool>
  const add = (length: Float, extinction: Float): void => {
    const width = position.sub(back).clamp(0, length).toConst() as Float
    const middle = position.sub(width.mul(0.5)).toConst() as Float
    const square = middle.mul(middle).add(width.mul(width).div(12))
    const own = extinction.mul(width).toConst() as Float
    const counted = own.min(sums.x.sub(MOST_COUNTED).negate().max(0)).toConst()
    sums.addAssign(vec3(1, middle, square).mul(counted))
    depth.addAssign(own)
    entry.assign(extinction.greaterThan(0).select(entry.max(position), entry))
    position.subAssign(length)
  }
  loop('shadowPair', PAIRS, index => {
    If(position.lessThanEqual(back), () => {
      Break()
    })
    const left = float(PAIRS).sub(index)
    const share = mix(1, LEAST_PART, left.div(PAIRS))
    const least = position.sub(back).mul(0.5).div(left).mul(share).toConst() as Float
    const isDeep = sums.x.greaterThanEqual(MOST_COUNTED * 0.999).toConst()
    const length = isDeep.select(even, wanted.max(fine)).max(least).toConst() as Float
    const width = footprint.max(length.mul(BLUR)).toConst() as Float
    const [middle, first, second] = [1, 0.5, 1.5].map(steps =>
      sampleAt(position.sub(length.mul(steps)).toConst(), width)
    )
    const { x, y, z: strength } = sampleLayerPair(field, layer, middle, [first, second])
    const isCloudy = x.max(y).greaterThan(0).toConst()
    const isTooLong = length.greaterThan(fine.max(least).mul(LOOK_BACK)).and(isDeep.not())
    const isJump = isCloudy.and(isClear).and(isTooLong).toConst() as Bool
    isClear.assign(isCloudy.not())
    const clear = strength.negate().max(0).mul(LIKELY).div(layer.perShapePeriod)
    // Short ones in clouds.
    wanted.assign(isCloudy.select(0, clear.min(even.mul(LONGEST))))
    If(isJump, () => {
      // Back to the last sample that was clear.
      position.subAssign(x.greaterThan(0).select(0, length.mul(0.5)))
    }).Else(() => {
      add(length, x)
      add(length, y)
    })
  })
  return { sums, depth, entry }
}
