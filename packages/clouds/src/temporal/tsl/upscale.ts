import { If, float, mix, smoothstep, uv, vec4 } from 'three/tsl'
import { outputs, type Outputs } from '@welkin/atmosphere'
import { select } from '../../select'
import type { Bool, Float, Vec2, Vec4 } from '../../tsl-types'
import { viewRayAt, viewRayEnd, type FrameInputs } from '../../march/tsl/viewRay'
import { isClear, type Cell } from './cells'
import { toHalf } from './ditheredHalf'
import { estimate, type Estimate } from './estimate'
import { interleavedNoise } from './noisePattern'
import { encodeDistance, FARTHEST, pack, unpack } from './packing'
import { CLEAR, type CloudTargets } from './renderTargets'
import { reprojectHistory, type ReprojectedHistory } from './reprojection'
import { varianceClip } from './varianceClip'
import { cellPosition, readCell } from './wholeCell'

/**
 * Extra clip tolerance of history, in units of brightness and of transmittance: of stationary pixels and of
 * all others. Details smaller than a block are not marched in every frame; without tolerance they flicker in
 * a still picture, with more of it clouds leave trails when they move (*Cumulus* with "Time lapse").
 */
const STATIONARY_SLACK = 1
const LEAST_SLACK = 0.01

/**
 * Accumulated samples over which stationary history gains that tolerance: younger history may be a trail
 * (*Cumulus* with "Time lapse").
 */
const YOUNG_SAMPLES = 1.5
const OLD_SAMPLES = 4

/**
 * Accumulated samples up to which a pixel also takes those of its neighbours, and from which on it goes by its own alone: few rays are
 * grain. Fewer: grain at edges of near clouds for seconds (*Inside a cloud*); more: still clouds blur (*Cumulus*).
 */
const SHARED_SAMPLES = 2
const OWN_SAMPLES = 10

/**
 * Square of the distance d at which a sample is of no use to its neighbours, to which it is worth (1 − d²/s)² [pixels²]. Greater: clouds
 * blur for seconds after a change (*Cumulus*); smaller: grain (*Inside a cloud*).
 */
const SHARED_SQUARE = 3

/**
 * Standard deviation of a cell's brightness, in parts of it, and three times that of its transmittance, below which clouds have nothing that
 * a bilinear look-up would blur [–]. Greater: faster (*Inside a cloud*), and thin clouds blur while they move.
 */
const SMOOTH = 0.01

/** A pixel's result, and the accumulated samples behind it. */
interface Accumulated {
  readonly light: Vec4
  readonly samples: Float
  /** log₂ of the distance of its clouds. */
  readonly distance: Float
}

/**
 * Blends this frame's estimate into clipped history, each by the samples that it is worth.
 *
 * @see Yang et al. 2020, "A survey of temporal antialiasing techniques", §3.3
 */
function accumulate(
  { light, samples, distance }: Accumulated,
  { frame }: FrameInputs,
  now: Estimate,
  history: ReprojectedHistory
): void {
  If(history.samples.greaterThan(0), () => {
    const slack = smoothstep(YOUNG_SAMPLES, OLD_SAMPLES, history.samples)
      .mul(history.stationarity.mul(STATIONARY_SLACK))
      .max(LEAST_SLACK)
    const clipped = varianceClip(history.light, now, frame.clipDeviations, slack)
    const isOwn = now.isOwn.or(history.samples.lessThan(1)).toConst() as Bool
    // A pixel with samples enough of its own learns nothing from its neighbours'.
    const youth = history.samples
      .sub(OWN_SAMPLES)
      .div(SHARED_SAMPLES - OWN_SAMPLES)
      .clamp()
    const near = now.nearest.mul(frame.block).mul(frame.block).div(-SHARED_SQUARE).add(1).max(0)
    const weight = select(isOwn, now.weight, 0).max(near.mul(near).mul(youth)).toConst()
    const all = history.samples.add(weight).toConst()
    const share = weight.div(all).toConst() as Float
    light.assign(mix(clipped, now.light, share))
    samples.assign(all.min(frame.maxSamples))
    // Clouds that this frame does not see are where they were. A distance follows own samples: in the mean with a neighbour's there may be no cloud.
    If(history.hasClouds, () => {
      const known = select(isOwn.and(now.light.w.lessThanEqual(CLEAR)), share.max(youth), 0)
      distance.assign(mix(history.distance, distance, known))
    })
  })
}

/**
 * Clouds in full resolution: this frame's estimate from the marched pixels, blended into history that is
 * reprojected, depth-tested and variance-clipped.
 *
 * Sample counts are stored with a minus sign where there is no cloud: where the cell is clear too, a pixel
 * is done without a look at its light.
 *
 * @param cells - Cells by `gatherCells`.
 * @param history - The target of the last frame.
 * @see Yang et al. 2020, "A survey of temporal antialiasing techniques", §5 (temporal upsampling)
 */
export function upscale(
  viewRays: FrameInputs,
  marched: CloudTargets,
  cells: CloudTargets,
  history: CloudTargets
): Outputs {
  const { frame } = viewRays
  return outputs<[Vec4, Vec4]>(2, ([light, distances]) => {
    const pixel = uv().mul(frame.size).floor().toConst() as unknown as Vec2
    const middle = pixel.add(0.5).div(frame.size).toConst() as Vec2
    const where = cellPosition(viewRays, pixel)
    const dither = interleavedNoise(pixel, frame.noiseShift).toConst() as Float
    const cellAt = where.corner.add(1.5).div(frame.marchedSize.add(1)).toConst() as Vec2
    const cellLight = cells.light.sample(cellAt).level(0).toConst() as Vec4
    // Reads that do not wait for each other: so it is with most below.
    const kept = history.distances.sample(middle).level(0).toConst() as Vec4
    const before = vec4(0).toVar() as Vec4
    If(isClear(cellLight).and(frame.hasHistory.greaterThan(0)), () => {
      before.assign(unpack(kept))
    })
    // Clear around and clear before: one more sample of nothing.
    const clearSamples = before.z.sub(frame.block.mul(frame.block).reciprocal())
    light.assign(vec4(0, 0, 0, 1))
    const clear = clearSamples.max(frame.maxSamples.negate())
    distances.assign(pack(float(FARTHEST), before.y, clear, dither))
    If(before.z.greaterThanEqual(0), () => {
      const cell: Cell = {
        light: cellLight,
        distances: cells.distances.sample(cellAt).level(0).toConst()
      }
      const whole = readCell(viewRays, marched, where)
      const ray = viewRayAt(viewRays, middle)
      const missesGround = cell.distances.z.greaterThanEqual(FARTHEST)
      const end = encodeDistance(viewRayEnd(viewRays, middle, ray, missesGround)).toConst() as Float
      const now = estimate(viewRays, marched, where, whole, cell, end)
      const result = now.light.toVar() as Vec4
      const samples = now.weight.toVar()
      const distance = now.distance.toVar()
      If(frame.hasHistory.greaterThan(0), () => {
        const origin = frame.originArray.element(cell.distances.w.toInt()).xyz
        const { x: brightness, z, w } = cellLight
        const isSmooth = z.max(w.mul(3).mul(brightness)).lessThan(brightness.mul(SMOOTH))
        const { distance: seen } = now
        const last = reprojectHistory(viewRays, history, pixel, ray, end, seen, origin, isSmooth)
        accumulate({ light: result, samples, distance }, viewRays, now, last)
      })
      const signed = select(result.w.greaterThan(CLEAR), samples.negate(), samples)
      light.assign(toHalf(result.max(0), dither))
      distances.assign(pack(distance, end, signed, dither))
    })
  })
}
