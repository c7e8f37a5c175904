import type { Bool, Float } from '../../tsl-types'
import { erosionForm } from '../formConstants'
import type { LayerNodes } from './layer'
import type { CloudWeather } from './weather'

/** Distance that is farther than any cloud [m]. */
export const NOWHERE = 1e6

/**
 * Distance over which the strength of a column changes by 1 at least, where the weather is steepest
 * [periods of the weather].
 */
const STEEPEST_WEATHER = 0.03

/** Distance over which strength less shape erosion changes by 1 at least [periods of the shape]. */
const STEEPEST_SHAPE = 0.05

/** What shape erosion takes from a layer for sure, whatever the noise [–]. */
export const surelyEroded = (layer: LayerNodes): Float =>
  layer.shapeAmount.mul(erosionForm.leastShape)

/** Whether a column may hold cloud of a layer, whatever the noise. */
export const mayHoldCloud = (
  layer: LayerNodes,
  { strength, unresolvedFraction, filteredCoverage }: CloudWeather
): Bool =>
  strength
    .greaterThan(surelyEroded(layer))
    .or(unresolvedFraction.mul(filteredCoverage).greaterThan(0))

/**
 * Empty distance by the weather alone: none of the layer's clouds is nearer, whatever the noise and the
 * height, since profiles are steep [m].
 */
export const emptyDistanceByWeather = (layer: LayerNodes, { strength }: CloudWeather): Float =>
  surelyEroded(layer).sub(strength).mul(STEEPEST_WEATHER).div(layer.perWeatherPeriod).max(0)

/**
 * Empty distance where the shape noise is known; below 0 in clouds [m].
 *
 * @param eroded - What shape erosion takes there.
 */
export const emptyDistanceByShape = (
  layer: LayerNodes,
  { strength }: CloudWeather,
  eroded: Float
): Float => eroded.sub(strength).mul(STEEPEST_SHAPE).div(layer.perShapePeriod)
