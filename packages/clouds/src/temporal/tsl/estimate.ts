import { If, float, mix, vec2, vec4 } from 'three/tsl'
import { select } from '../../select'
import { loop, type Bool, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import type { FrameInputs } from '../../march/tsl/viewRay'
import { LEAST_OPACITY, passesCellDepthTest, type Cell } from './cells'
import { passesDepthTest } from './depthTest'
import { SAMPLE_STEPS } from './packing'
import { brightness, CLEAR, type CloudTargets } from './renderTargets'
import type { Neighbourhood } from './varianceClip'
import {
  inMarched,
  OWN_SAMPLE,
  weightOf,
  type CellPosition,
  type CornerKernel,
  type WholeCell
} from './wholeCell'

/** Least weight: that of pixels with no marched one near by. */
const LEAST_WEIGHT = 1 / SAMPLE_STEPS

/** Greatest deviation of four numbers from their mean, in standard deviations, and the greatest transmittance of corners whose distances are mixed. */
const MOST_ABOVE = Math.sqrt(3)
const MOST_PASSED = 0.9

/** Square of a distance beyond any corner [marched pixels²]. */
const NO_CORNER = 100

/** Standard deviations where no corner passes: nothing is known, and history stays. */
const UNKNOWN = 100

/** Estimate of a pixel from this frame's marched pixels alone. */
export interface Estimate extends Neighbourhood {
  readonly light: Vec4
  /** log₂ of the clouds' distance: the marched pixel's own where there is one; else mixed as the light is, or the cell's mean if a corner may be clear. */
  readonly distance: Float
  /** Samples that it is worth, in [0, 1]: 1 at a marched pixel, 0 where no ray around went as far. */
  readonly weight: Float
  /** True at a marched pixel. */
  readonly isOwn: Bool
  /** Square of the distance to the nearest marched pixel that counts [marched pixels²]. */
  readonly nearest: Float
}

/** Variables that an estimate is gathered in. */
interface Gathered {
  light: Vec4
  mean: Vec4
  statistics: Vec4
  distance: Float
  /** Square of the distance to the nearest corner that passes [marched pixels²]. */
  nearest: Float
}

/** Estimate from those corners of a cell that pass the depth test, one by one. */
function gatherCorners(
  gathered: Gathered,
  { frame }: FrameInputs,
  marched: CloudTargets,
  corner: Vec2,
  kernel: CornerKernel,
  end: Float
): void {
  const { light, mean, statistics, distance, nearest } = gathered
  const total = vec4(0).toVar() as Vec4
  /** Sums of brightness and transmittance, and of their squares. */
  const moments = vec4(0).toVar() as Vec4
  /** Sums of weights; of corners that pass; of weighted distances, and of their weights. */
  const sums = vec4(0).toVar() as Vec4
  nearest.assign(NO_CORNER)
  loop('corner', 4, index => {
    const step = vec2(float(index.mod(2)), float(index.div(2))).toConst() as Vec2
    const pixel = corner.add(step).clamp(vec2(0), frame.marchedSize.sub(1))
    const at = pixel.add(0.5).div(frame.marchedSize).toConst() as Vec2
    const color = marched.light.sample(at).level(0).toConst() as Vec4
    const apart = marched.distances.sample(at).level(0).toConst() as Vec4
    const passes = passesDepthTest(end, apart).toConst() as Float
    const share = mix(kernel.blend.oneMinus(), kernel.blend, step).toConst() as Vec2
    const weight = share.x.mul(share.y).mul(passes).toConst() as Float
    const seen = weight.mul(color.w.oneMinus().add(LEAST_OPACITY)).toConst() as Float
    const value = vec2(brightness(color), color.w).toConst() as Vec2
    light.addAssign(color.mul(weight))
    total.addAssign(color.mul(passes))
    moments.addAssign(vec4(value, value.mul(value)).mul(passes))
    sums.addAssign(vec4(weight, passes, apart.x.mul(seen), seen))
    const square = mix(kernel.first, kernel.second, step).toConst() as Vec2
    nearest.assign(nearest.min(select(passes.greaterThan(0), square.x.add(square.y), NO_CORNER)))
  })
  const count = sums.y.max(1)
  const average = moments.div(count).toConst() as Vec4
  const variance = average.zw.sub(average.xy.mul(average.xy)).max(0)
  statistics.assign(vec4(0, 1, UNKNOWN, UNKNOWN))
  // Or else nothing was marched as far as this pixel sees: what is in front of clouds sees none.
  If(sums.y.greaterThan(0), () => {
    mean.assign(total.div(count))
    statistics.assign(vec4(brightness(mean), mean.w, variance.sqrt()))
  })
  light.assign(select(sums.x.greaterThan(1e-6), light.div(sums.x.max(1e-7)), mean))
  distance.assign(select(sums.w.greaterThan(0), sums.z.div(sums.w.max(1e-9)), end))
}

/**
 * Estimate of a pixel from the marched pixels around it: from the whole cell, with one bilinear look-up,
 * where the pixel passes its depth test; or else from those corners that it passes alone.
 *
 * @param whole - `readCell` of its position.
 * @param end - log₂ of the distance at which the pixel ends.
 * @see Kopf et al. 2007, "Joint bilateral upsampling", eq. 3: weights by distance in the image and by depth
 */
export function estimate(
  viewRays: FrameInputs,
  marched: CloudTargets,
  { corner }: CellPosition,
  whole: WholeCell,
  cell: Cell,
  end: Float
): Estimate {
  const isWhole = passesCellDepthTest(end, cell.distances).toConst() as Bool
  const gathered: Gathered = {
    light: vec4(0).toVar(),
    mean: vec4(0, 0, 0, 1).toVar(),
    statistics: cell.light.toVar(),
    distance: cell.distances.x.toVar(),
    nearest: whole.closest.toVar()
  }
  const { light, mean, statistics, distance, nearest } = gathered
  If(isWhole, () => {
    light.assign(whole.light)
  }).Else(() => {
    gatherCorners(gathered, viewRays, marched, corner, whole.kernel, end)
  })
  const weight = weightOf(viewRays, nearest)
  const isOwn = weight.greaterThan(OWN_SAMPLE).toConst() as Bool
  // At edges of near clouds before far ones the cell's mean is the distance of neither: it is mixed as light is, where all corners see clouds.
  const { y: passed, w: deviation } = cell.light
  const isFilled = deviation.mul(MOST_ABOVE).add(passed).lessThan(MOST_PASSED)
  If(isOwn.or(isFilled).and(isWhole).and(light.w.lessThan(CLEAR)), () => {
    distance.assign(whole.distance)
  })
  return {
    light,
    mean: () => {
      If(isWhole, () => {
        mean.assign(marched.light.sample(inMarched(viewRays, corner.add(0.5))).level(0))
      })
      return mean
    },
    statistics,
    distance,
    weight: select(nearest.lessThan(NO_CORNER), weight.max(LEAST_WEIGHT), 0).toConst(),
    isOwn,
    nearest
  }
}
