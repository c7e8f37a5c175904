import { float, vec3 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../../density/CloudField'
import type { LayerNodes } from '../../density/tsl/layer'
import type { FallingDecks } from '../../environment/tsl/decks'
import type { CloudSample } from '../../density/tsl/sample'
import { loop, type Float, type Vec3 } from '../../tsl-types'
import type { LayerSegment } from './layerSegment'
import { NO_CLOUDS, type StretchMoments } from './segmentMoments'

/** Rain and snow as shadow maps see them. */
export interface ShadingFall extends FallingDecks {
  /** Altitude above which nothing falls; below 0 where nothing falls at all [m]. */
  readonly ceiling: Float
  /** Extinction of light by what falls from a layer, without what is only diffracted [1/m]. */
  extinctionAt(field: CloudField, layer: LayerNodes, sample: CloudSample): Float
}

/** Samples of a ray of light through what falls. Fewer: bands in the shadows of shafts (*Rain and snow*). */
const FALL_STEPS = 16

/** Precipitation on a stretch of a ray. */
export function fallMoments(
  field: CloudField,
  falling: ShadingFall,
  layer: LayerNodes,
  { front, back }: LayerSegment,
  sampleAt: (distance: Float) => CloudSample
): StretchMoments {
  const length = front.sub(back).div(FALL_STEPS).toConst() as Float
  const sums = vec3(0).toVar() as Vec3
  loop('fallShade', FALL_STEPS, index => {
    const at = front.sub(length.mul(float(index).add(0.5))).toConst() as Float
    // Shadow maps have depths that are scaled when they are read.
    const extinction = falling.extinctionAt(field, layer, sampleAt(at)).div(field.depthScale)
    sums.addAssign(vec3(1, at, at.mul(at)).mul(extinction.mul(length)))
  })
  return { sums, entry: select(sums.x.greaterThan(0), front, NO_CLOUDS) }
}
