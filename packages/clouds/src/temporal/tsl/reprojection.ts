import { If, exp2, vec2, vec4 } from 'three/tsl'
import { select } from '../../select'
import type { Bool, Float, Mat3, Vec2, Vec3, Vec4 } from '../../tsl-types'
import type { FrameInputs, PixelRay } from '../../march/tsl/viewRay'
import { passesDepthTest, SAME_DISTANCE } from './depthTest'
import { clampDistance, unpack } from './packing'
import type { CloudTargets } from './renderTargets'
import { sharpSample } from './sharpSample'

/**
 * Motion below which history is read at the pixel's own texel, so that filtering does not blur a picture
 * that stands still [pixels]. Greater: slow clouds lag behind; 0: still ones blur (*Cumulus* with "Time lapse").
 */
const STILL_MOTION = 0.02

/**
 * Motion above which history is read between pixels in each frame [pixels], and the most that it is worth then [samples]. More: clouds blur
 * while one turns, and for a second after (*Cockpit*); less: grain.
 */
const FAST_MOTION = 1
const FAST_SAMPLES = 4

/**
 * Error of the reprojection at which history is rejected: clouds at another distance than this pixel's [pixels].
 * Greater: near clouds trail over far ones as one flies past (*Storm*).
 */
const MAX_PARALLAX = 4

/** Reprojected history of a pixel. */
export interface ReprojectedHistory {
  /** Light at this frame's gain, and transmittance. */
  readonly light: Vec4
  /** Accumulated samples that it is worth; 0 where it is rejected. */
  readonly samples: Float
  /** log₂ of the distance of its clouds, if it has any. */
  readonly distance: Float
  readonly hasClouds: Bool
  /** Stationarity: 1 where neither clouds nor what was drawn have moved but by a turn of the camera, falling to 0 at a pixel's motion, and as the clouds' form changes. */
  readonly stationarity: Float
}

/**
 * Reads history where a pixel's clouds were in the last frame, by their distance and by the wind of their
 * layer, and rejects it where it is outside of the picture, fails the depth test, or held clouds at another
 * distance.
 *
 * @param end - log₂ of the distance at which the pixel ends.
 * @param distance - log₂ of the distance of its clouds.
 * @param origin - Element of `FrameUniforms.origins` of their layer.
 * @param isSmooth - True where there is nothing that a bilinear look-up would blur.
 * @see Yang et al. 2020, "A survey of temporal antialiasing techniques", §3.2 (reprojection), §4.1 (rejection)
 */
export function reprojectHistory(
  { frame }: FrameInputs,
  history: CloudTargets,
  pixel: Vec2,
  { ndc, length }: PixelRay,
  end: Float,
  distance: Float,
  origin: Vec3,
  isSmooth: Bool
): ReprojectedHistory {
  /** Clip space (x, y, w) of the last frame to its pixels. */
  const pixelOf = ({ xy, z }: Vec3): Vec2 =>
    xy.div(z.max(1e-9)).mul(vec2(0.5, -0.5)).add(0.5).mul(frame.size).sub(0.5).toConst()
  const farBefore = (frame.raysBefore as unknown as Mat3).mul(ndc).toConst() as Vec3
  const clipped = farBefore.add(origin.mul(length.div(exp2(distance)))).toConst() as Vec3
  const before = pixelOf(clipped)
  const motion = before.sub(pixel).toConst() as Vec2
  // A turn moves all alike, whatever its distance.
  const shift = before.sub(pixelOf(farBefore)).length().toConst() as Float
  const isStill = motion.x.abs().max(motion.y.abs()).lessThan(STILL_MOTION)
  const from = pixel
    .add(select(isStill, vec2(0), motion))
    .add(0.5)
    .toConst() as Vec2
  const isInside = from.clamp(vec2(0), frame.size).equal(from).all().and(clipped.z.greaterThan(0))
  const nearest = from.floor().add(0.5).div(frame.size)
  const packed = history.distances.sample(nearest).level(0).toConst() as Vec4
  const clampedEnd = clampDistance(end).toConst() as Float
  const light = history.light.sample(from.div(frame.size)).level(0).toVar() as Vec4
  If(isStill.or(isSmooth).not(), () => {
    light.assign(sharpSample(history.light, from, frame.size))
    // Transmittance, which overshoots at edges.
    light.w.assign(light.w.min(1))
  })
  const apart = unpack(packed)
  // Parallax: clouds at the distance of history would have moved by this ratio of the shift more or less.
  const ratio = exp2(distance.sub(apart.x)).sub(1).abs()
  const parallax = ratio.mul(shift).div(MAX_PARALLAX).oneMinus().clamp()
  const validity = select(isInside, passesDepthTest(clampedEnd, apart), 0).mul(parallax)
  const { gainChange, maxSamples } = frame
  const isFast = motion.length().greaterThan(FAST_MOTION)
  const most = select(isFast, maxSamples.min(FAST_SAMPLES), maxSamples)
  const isSameEnd = clampedEnd.sub(apart.y).abs().lessThan(SAME_DISTANCE)
  return {
    distance: apart.x,
    hasClouds: apart.z.greaterThan(0),
    light: light.mul(vec4(gainChange, gainChange, gainChange, 1)).toConst(),
    stationarity: select(isSameEnd, shift.oneMinus().max(0).mul(frame.steadiness), 0),
    samples: apart.z.abs().min(most).mul(validity).toConst()
  }
}
