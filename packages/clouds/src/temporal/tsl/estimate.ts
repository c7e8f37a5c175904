import { If, float, mix, vec2, vec4 } from 'three/tsl'
import { select } from '../../select'
import { loop, type Bool, type Float, type Vec2, type Vec4 } from '../../tsl-types'
import type { FrameInputs } from '../../march/tsl/viewRay'
import { LEAST_OPACITY, passesCellDepthTest, type Cell } from './cells'
import { passesDepthTest } from './depthTest'
import { SAMPLE_STEPS } from './packing'
import { brightness, CLEAR, type CloudTargets } from './renderTargets'
import type { Neighbourhood } from './varianceClip'

/**
 * Sharpness s of the kernel e^{−s d²} that interpolates marched pixels, d in marched pixels. Greater: blocks
 * show while one turns; smaller: blur (*Cumulus*).
 */
const INTERPOLATION_SHARPNESS = 7

/**
 * Sharpness of the kernel by which a marched pixel's weight falls off around it, per pixel squared. Smaller:
 * still clouds blur (*Cumulus*).
 */
const WEIGHT_SHARPNESS = 5

/** Least weight: that of pixels with no marched one near by. */
const LEAST_WEIGHT = 1 / SAMPLE_STEPS

/**
 * Weight above which an estimate is a pixel's own sample rather than its neighbours'. Smaller: still clouds
 * blur (*Cumulus*).
 */
const OWN_SAMPLE = 0.5

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
}

/** Position of a pixel among marched ones. */
export interface CellPosition {
  /** Index of the cell's first corner. */
  readonly corner: Vec2
  /** Position from there on, in [0, 1). */
  readonly part: Vec2
}

/** The cell that a pixel is in. */
export function cellPosition({ frame }: FrameInputs, pixel: Vec2): CellPosition {
  const at = pixel.sub(frame.jitter).div(frame.block).add(1e-3).toConst() as Vec2
  const corner = at.floor().toConst() as Vec2
  return { corner, part: at.sub(corner).toConst() }
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

/** Kernel over the corners of a cell, for one pixel in it. */
interface CornerKernel {
  /** Weights of the second corner along each axis. */
  readonly blend: Vec2
  /** Squares of the distances to the first and to the second corner along each axis [marched pixels²]. */
  readonly first: Vec2
  readonly second: Vec2
}

/** Weights e^{−s p²} and e^{−s (1−p)²} in proportion: as far as a bilinear look-up has to go. */
function cornerKernel(part: Vec2): CornerKernel {
  const steepness = part.mul(2).oneMinus().mul(INTERPOLATION_SHARPNESS)
  const blend = steepness.exp().add(1).reciprocal().toConst() as Vec2
  const first = part.mul(part).toConst() as Vec2
  const second = part.oneMinus().mul(part.oneMinus()).toConst() as Vec2
  return { blend, first, second }
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
 * @param end - log₂ of the distance at which the pixel ends.
 * @see Kopf et al. 2007, "Joint bilateral upsampling", eq. 3: weights by distance in the image and by depth
 */
export function estimate(
  viewRays: FrameInputs,
  marched: CloudTargets,
  { corner, part }: CellPosition,
  cell: Cell,
  end: Float
): Estimate {
  const { frame } = viewRays
  const at = (pixel: Vec2): Vec2 => pixel.add(0.5).div(frame.marchedSize).toConst()
  const kernel = cornerKernel(part)
  const closest = kernel.first.min(kernel.second).toConst() as Vec2
  const isWhole = passesCellDepthTest(end, cell.distances).toConst() as Bool
  const gathered: Gathered = {
    light: vec4(0).toVar(),
    mean: vec4(0, 0, 0, 1).toVar(),
    statistics: cell.light.toVar(),
    distance: cell.distances.x.toVar(),
    nearest: closest.x.add(closest.y).toVar()
  }
  const { light, mean, statistics, distance, nearest } = gathered
  If(isWhole, () => {
    light.assign(marched.light.sample(at(corner.add(kernel.blend))).level(0))
  }).Else(() => {
    gatherCorners(gathered, viewRays, marched, corner, kernel, end)
  })
  const weight = nearest.mul(frame.block).mul(frame.block).mul(-WEIGHT_SHARPNESS).exp().toConst()
  const isOwn = weight.greaterThan(OWN_SAMPLE).toConst() as Bool
  // At edges of near clouds before far ones the cell's mean is the distance of neither: it is mixed as light is, where all corners see clouds.
  const { y: passed, w: deviation } = cell.light
  const isFilled = deviation.mul(MOST_ABOVE).add(passed).lessThan(MOST_PASSED)
  If(isOwn.or(isFilled).and(isWhole).and(light.w.lessThan(CLEAR)), () => {
    const place = select(isOwn, kernel.blend.round(), kernel.blend)
    distance.assign(marched.distances.sample(at(corner.add(place))).level(0).x)
  })
  return {
    light,
    mean: () => {
      If(isWhole, () => {
        mean.assign(marched.light.sample(at(corner.add(0.5))).level(0))
      })
      return mean
    },
    statistics,
    distance,
    weight: select(nearest.lessThan(NO_CORNER), weight.max(LEAST_WEIGHT), 0).toConst(),
    isOwn
  }
}
