import { select } from '../../select'
import type { FrameInputs } from '../../march/tsl/viewRay'
import type { Float, Vec2, Vec4 } from '../../tsl-types'
import type { CloudTargets } from './renderTargets'

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

/**
 * Weight above which an estimate is a pixel's own sample rather than its neighbours'. Smaller: still clouds
 * blur (*Cumulus*).
 */
export const OWN_SAMPLE = 0.5

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

/** Kernel over the corners of a cell, for one pixel in it. */
export interface CornerKernel {
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

/** Light and distance of a cell at a pixel, for cells that pass the depth test as a whole. */
export interface WholeCell {
  readonly kernel: CornerKernel
  /** Square of the distance to the nearest corner [marched pixels²]. */
  readonly closest: Float
  readonly light: Vec4
  /** log₂ of the clouds' distance. */
  readonly distance: Float
}

/** Weight of the nearest marched pixel, by the square of its distance [marched pixels²]. */
export const weightOf = ({ frame }: FrameInputs, nearest: Float): Float =>
  nearest.mul(frame.block).mul(frame.block).mul(-WEIGHT_SHARPNESS).exp().toConst()

/** Place in the marched picture of a place among its pixels. */
export const inMarched = ({ frame }: FrameInputs, pixel: Vec2): Vec2 =>
  pixel.add(0.5).div(frame.marchedSize).toConst()

/** Reads a cell before it is known whether the pixel passes its depth test, so that the reads wait for no others. */
export function readCell(
  viewRays: FrameInputs,
  marched: CloudTargets,
  { corner, part }: CellPosition
): WholeCell {
  const kernel = cornerKernel(part)
  const nearest = kernel.first.min(kernel.second).toConst() as Vec2
  const closest = nearest.x.add(nearest.y).toConst() as Float
  const isOwn = weightOf(viewRays, closest).greaterThan(OWN_SAMPLE)
  const place = select(isOwn, kernel.blend.round(), kernel.blend) as Vec2
  const [at, ofDistance] = [kernel.blend, place].map(each => inMarched(viewRays, corner.add(each)))
  return {
    kernel,
    closest,
    light: marched.light.sample(at).level(0).toConst(),
    distance: marched.distances.sample(ofDistance).level(0).x.toConst()
  }
}
