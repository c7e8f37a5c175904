import { Fn, If, float, uv, vec2, vec4 } from 'three/tsl'
import type { CloudField } from '../../density/CloudField'
import {
  twoOutputs,
  type Bool,
  type Float,
  type Int,
  type TwoOutputs,
  type Vec2,
  type Vec4
} from '../../tsl-types'
import { forLayers, layerAt } from '../../density/tsl/layer'
import { brightness, CLEAR, FARTHEST, SAME, type CloudPictures } from './pictures'
import { viewRayAt, type ViewRayNodes } from '../../march/tsl/viewRay'

/** Of a cell none of whose corners sees a cloud, and the most of others: half floats tell them apart. */
const ALL_CLEAR = 1
const NOT_CLEAR = 0.9985

/** What is never reached, and what nothing is near to, by distance as it is stored. */
const NEVER = 2 * FARTHEST
const NOTHING = -FARTHEST

/**
 * What the four marched pixels around a place have in common: between them lies a cell, which a pixel of
 * the picture need not look into if it is like all of them.
 */
export interface Cell {
  /** Means of brightness and transmittance, and their standard deviations. */
  readonly light: Vec4
  /**
   * Mean distance, by opacity; the end that a pixel has to be beyond to see the same as all corners, and
   * the one it has to be near to; the layer whose wind counts. Distances are log₂.
   */
  readonly place: Vec4
}

/** The corners of a cell. */
const CORNERS = [
  [0, 0],
  [1, 0],
  [0, 1],
  [1, 1]
] as const

/** Whether no corner sees a cloud. */
export const isClear = ({ y: transmittance }: Vec4): Bool =>
  transmittance.greaterThan((ALL_CLEAR + NOT_CLEAR) / 2)

/** Whether a pixel sees the same as all corners: it ends beyond their clouds, or where they do. */
export const fitsCell = (end: Float, { y: beyond, z: near }: Vec4): Bool =>
  end.greaterThan(beyond).or(end.sub(near).abs().lessThan(SAME))

/** The layer that is nearest to an altitude, by its thickness. */
function layerNear(field: CloudField, altitude: Float): Float {
  const nearest = float(0).toVar()
  if (field.layers.length === 1) return nearest
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
  sights: ViewRayNodes,
  marched: CloudPictures
): TwoOutputs {
  const { frame } = sights
  return twoOutputs(([light, place]) =>
    Fn(() => {
      const corner = uv().mul(frame.marchedSize.add(1)).floor().sub(1).toConst() as unknown as Vec2
      const first = vec2(0).toVar() as Vec2
      const second = vec2(0).toVar() as Vec2
      /** Sum of weights, and of distances. */
      const seen = vec2(0).toVar() as Vec2
      const least = float(1).toVar()
      /** Farthest cloud, nearest and farthest end. */
      const farthest = float(0).toVar()
      const ends = vec2(NEVER, 0).toVar() as Vec2
      for (const step of CORNERS) {
        const index = corner.add(vec2(...step)).clamp(vec2(0), frame.marchedSize.sub(1))
        const at = index.add(0.5).div(frame.marchedSize).toConst() as Vec2
        const color = marched.light.sample(at).level(0).toConst() as Vec4
        const about = marched.place.sample(at).level(0).toConst() as Vec4
        const value = vec2(brightness(color), color.w).toConst() as Vec2
        first.addAssign(value)
        second.addAssign(value.mul(value))
        seen.addAssign(vec2(1, about.x).mul(color.w.oneMinus().add(1e-3)))
        least.assign(least.min(color.w))
        farthest.assign(farthest.max(about.x))
        ends.assign(vec2(ends.x.min(about.y), ends.y.max(about.y)))
      }
      const count = CORNERS.length
      const mean = first.div(count).toConst() as Vec2
      const deviation = second.div(count).sub(mean.mul(mean)).max(0).sqrt()
      const distance = seen.y.div(seen.x).toConst() as Float
      const transmittance = least.greaterThan(CLEAR).select(ALL_CLEAR, mean.y.min(NOT_CLEAR))
      light.assign(vec4(mean.x, transmittance, deviation))
      const middle = corner.add(0.5).mul(frame.block).add(frame.jitter).add(0.5).div(frame.size)
      const { direction } = viewRayAt(sights, middle.toConst())
      const { altitude } = field.view.place(direction.mul(distance.exp2()))
      place.assign(
        vec4(
          distance,
          ends.x.greaterThan(farthest).select(farthest, NEVER),
          ends.y.sub(ends.x).lessThan(SAME).select(ends.x.add(ends.y).mul(0.5), NOTHING),
          layerNear(field, altitude)
        )
      )
      return vec4(0)
    })()
  )
}
