import { If, float, uv, vec2, vec4 } from 'three/tsl'
import { outputs, type Outputs } from '@welkin/atmosphere'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { Bool, Float, Int, Vec2, Vec4 } from '../../tsl-types'
import { forLayers, layerAt } from '../../density/tsl/layer'
import { viewRayAt, type FrameInputs } from '../../march/tsl/viewRay'
import { SAME_DISTANCE } from './depthTest'
import { FARTHEST } from './packing'
import { brightness, CLEAR, type CloudTargets } from './renderTargets'

/** Transmittance of a cell none of whose corners sees a cloud, and the most of others: half floats tell them apart. */
const ALL_CLEAR = 1
const NOT_CLEAR = 0.9985

/** log₂ distances that no end reaches, and that no end is near to. */
const NEVER = 2 * FARTHEST
const NOTHING = -FARTHEST

/**
 * Cell between four neighbouring marched pixels, its corners: their statistics, and the ends for which all
 * four pass the depth test. A pixel in between that passes it too takes these statistics as they are.
 */
export interface Cell {
  /** Means of brightness and transmittance, and their standard deviations. */
  readonly light: Vec4
  /**
   * log₂ of the mean distance of clouds, weighted by opacity; log₂ of the end beyond which a pixel sees
   * what all corners see, and of the end that it may be near to instead; index of the layer with whose wind
   * history is reprojected.
   */
  readonly distances: Vec4
}

/** Corners of a cell between four pixels of a grid [pixels]. */
export const CORNERS = [
  [0, 0],
  [1, 0],
  [0, 1],
  [1, 1]
] as const

/** Opacity by which corners without a cloud count, so that there is a distance where none sees one. */
export const LEAST_OPACITY = 1e-5

/** True if no corner sees a cloud. */
export const isClear = ({ y: transmittance }: Vec4): Bool =>
  transmittance.greaterThan((ALL_CLEAR + NOT_CLEAR) / 2)

/** Depth test against all corners of a cell: the pixel ends beyond their clouds, or where they end. */
export const passesCellDepthTest = (end: Float, { y: beyond, z: near }: Vec4): Bool =>
  end.greaterThan(beyond).or(end.sub(near).abs().lessThan(SAME_DISTANCE))

/** Index of the layer whose middle is nearest to an altitude, in its thicknesses. */
function nearestLayer(field: CloudField, altitude: Float): Float {
  const nearest = float(0).toVar()
  const least = float(1e9).toVar()
  forLayers(field, (index: Int) => {
    const { baseAltitude, perThickness } = layerAt(field, index)
    const apart = altitude.sub(baseAltitude).mul(perThickness).sub(0.5).abs().toConst() as Float
    If(apart.lessThan(least), () => {
      least.assign(apart)
      nearest.assign(float(index))
    })
  })
  return nearest
}

/** Draws {@link Cell}s: one more along each edge than there are marched pixels. */
export function gatherCells(
  field: CloudField,
  viewRays: FrameInputs,
  marched: CloudTargets
): Outputs {
  const { frame } = viewRays
  return outputs<[Vec4, Vec4]>(2, ([light, distances]) => {
    const corner = uv().mul(frame.marchedSize.add(1)).floor().sub(1).toConst() as unknown as Vec2
    /** Sums of brightness and transmittance, and of their squares. */
    const first = vec2(0).toVar() as Vec2
    const second = vec2(0).toVar() as Vec2
    /** Sums of weights, and of weighted distances. */
    const seen = vec2(0).toVar() as Vec2
    const least = float(1).toVar()
    /** Farthest cloud; nearest and farthest end. */
    const farthest = float(0).toVar()
    const ends = vec2(NEVER, 0).toVar() as Vec2
    for (const step of CORNERS) {
      const index = corner.add(vec2(...step)).clamp(vec2(0), frame.marchedSize.sub(1))
      const at = index.add(0.5).div(frame.marchedSize).toConst() as Vec2
      const color = marched.light.sample(at).level(0).toConst() as Vec4
      const apart = marched.distances.sample(at).level(0).toConst() as Vec4
      const value = vec2(brightness(color), color.w).toConst() as Vec2
      first.addAssign(value)
      second.addAssign(value.mul(value))
      seen.addAssign(vec2(1, apart.x).mul(color.w.oneMinus().add(LEAST_OPACITY)))
      least.assign(least.min(color.w))
      farthest.assign(farthest.max(apart.x))
      ends.assign(vec2(ends.x.min(apart.y), ends.y.max(apart.y)))
    }
    const count = CORNERS.length
    const mean = first.div(count).toConst() as Vec2
    const deviation = second.div(count).sub(mean.mul(mean)).max(0).sqrt()
    const distance = seen.y.div(seen.x).toConst() as Float
    const transmittance = select(least.greaterThan(CLEAR), ALL_CLEAR, mean.y.min(NOT_CLEAR))
    light.assign(vec4(mean.x, transmittance, deviation))
    const middle = corner.add(0.5).mul(frame.block).add(frame.jitter).add(0.5).div(frame.size)
    const { direction } = viewRayAt(viewRays, middle.toConst())
    const { altitude } = field.view.localCoordinates(direction.mul(distance.exp2()))
    distances.assign(
      vec4(
        distance,
        select(ends.x.greaterThan(farthest), farthest, NEVER),
        select(ends.y.sub(ends.x).lessThan(SAME_DISTANCE), ends.x.add(ends.y).mul(0.5), NOTHING),
        nearestLayer(field, altitude)
      )
    )
  })
}
