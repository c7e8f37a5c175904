import { If, float, mix, vec4 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import type { WeatherMap } from '../WeatherMap'
import type { Float, Int } from '../../tsl-types'
import { componentAt } from './componentAt'
import { neededStrength } from './heightForm'
import { forLayersUnrolled, heightIn, layerAt, type LayerNodes, type LayerRange } from './layer'
import { NOWHERE } from './likelyDistance'
import { subpointOffset, type CloudSample } from './sample'
import type { ClearLayers } from './samplePair'
import { leanAt } from './weather'

/**
 * Distance over which the strength of columns likely changes by 1, at coverage 1 [periods of the weather]: the less is
 * covered, the steeper they are. Greater: faster, and small clouds are missed here and there, as grain (*Cumulus*).
 */
const LIKELY_COLUMN = 0.0225

/**
 * Strength that billows and turbulence may add to a column at the layer's base, for shape amount 1 [–]; twice as much at its top. Smaller:
 * the same.
 */
const BILLOWS = 3

/** Strength that towers gain on the way up into their anvil [–]. Smaller: rims of anvils are missed (*Storm*). */
const ANVIL = 1

/**
 * Distance in which a layer likely has no cloud, by its column alone. 0 where that is not known [m].
 *
 * @param sample - Within the layer's altitudes, or else it is taken to be at its boundary.
 */
function clearDistance(
  field: CloudField,
  map: WeatherMap,
  layer: LayerNodes,
  index: Int,
  sample: CloudSample
): Float {
  const height = heightIn(layer, sample.altitude).clamp(0, 1).toConst() as Float
  const subpoint = subpointOffset(field, sample).sub(leanAt(layer, sample.up, height))
  const column = map.columnAt(index, subpoint.toConst())
  const billows = layer.shapeAmount.mul(height.add(1)).mul(BILLOWS).add(layer.anvil.mul(ANVIL))
  const lacking = neededStrength(layer, height).sub(column.x).sub(billows).max(0)
  return lacking.mul(column.y).mul(LIKELY_COLUMN).div(layer.perWeatherPeriod).toConst()
}

/**
 * Distance in which there is likely no cloud of any layer, by columns alone: an eighth of what a pair of samples costs.
 *
 * @param clear - Clear layers, kept between samples of a ray.
 * @param trust - Part of that distance which is told, in [0, 1].
 */
export function clearColumns(
  field: CloudField,
  map: WeatherMap,
  clear: ClearLayers,
  sample: CloudSample,
  range: LayerRange,
  trust: Float
): Float {
  const nearest = float(NOWHERE).toVar()
  const isAlone = field.layers.length === 1
  const look = (index: Int): void => {
    const layer = layerAt(field, index)
    const distance = (): Float => clearDistance(field, map, layer, index, sample).mul(trust)
    if (isAlone) {
      nearest.assign(distance())
      return
    }
    If(layer.coverage.greaterThan(0), () => {
      const own = componentAt(float(index))
      const until = clear.dot(own).toVar() as Float
      If(until.lessThanEqual(sample.distance), () => {
        until.assign(sample.distance.add(distance()))
        clear.assign(mix(clear, vec4(until), own))
      })
      nearest.assign(nearest.min(until.sub(sample.distance)))
    })
  }
  forLayersUnrolled(field, look, range)
  return nearest
}
