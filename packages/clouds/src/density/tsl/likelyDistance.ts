import { float, vec2 } from 'three/tsl'
import type { CloudField } from '../CloudField'
import { stormBillows } from '../stormForm'
import type { Float, Vec2 } from '../../tsl-types'
import { neededStrength } from './heightForm'
import type { LayerNodes } from './layer'
import { resolutionAt } from './resolution'
import { footprintOf, subpointOffset, type CloudSample } from './sample'
import { smoothStormStrength } from './stormStrength'
import { columnStrength } from './strength'
import { cloudWeather, leanAt } from './weather'
import { unpackBackground, type PackedBackground } from './weatherBackground'

/** Distance that is farther than any cloud [m]. */
export const NOWHERE = 1e6

/**
 * Distance over which the strength of clear air changes by 1 in the mean towards a cloud [periods of the
 * shape]. Greater: faster, and small clouds are missed here and there, as grain (*Cumulus*).
 */
const LIKELY = 0.012

/**
 * Part of the likely distance that is gone by: the rest is left for clouds that are nearer than likely. Greater:
 * faster, and small clouds are missed here and there, as grain (*Cumulus*).
 */
export const CAUTION = 0.45

/**
 * Likely distance of a layer's clouds: strength is too wild for a distance that is sure, so a march that goes
 * by this has to look back. 0 in clouds [m].
 *
 * @param strength - Strength of a `LayerSample`.
 */
export const likelyDistance = (layer: LayerNodes, strength: Float): Float =>
  strength.negate().max(0).mul(LIKELY).div(layer.perShapePeriod)

/**
 * Most that billows add to the strength of clear air, and what anvils add: they spread from column to
 * column, and so no background rules them out [–]. Smaller: faster, and small clouds are missed in clear
 * regions, as grain (*Cumulus*).
 */
const MOST_BILLOWS = 1.4
const ANVIL = 99

/**
 * Distance over which the background's part of the strength changes by 1 [periods of the weather]. Greater: faster, and
 * edges of clear regions get ragged (*Cockpit*).
 */
const BACKGROUND_LIKELY = 0.12

/** Distance that is taken off per footprint: from afar clouds blur [–]. Smaller: far clouds vanish (*Cockpit*). */
const BLUR = 32

/**
 * Likely distance of a layer's clouds where its background rules them out, whatever single clouds and billows
 * add: there these need not be looked up [m]. 0 or less elsewhere.
 *
 * @param height - Height in the layer, from 0 at its base to 1 at its top.
 * @param footprint - Width of what a sample stands for [m].
 */
export function likelyDistanceByBackground(
  layer: LayerNodes,
  background: PackedBackground,
  height: Float,
  footprint: Float
): Float {
  const { sum, coverage } = unpackBackground(background)
  const most = { sum: sum.add(layer.weights.length().mul(0.5)) }
  const sharp = { billowsLost: float(0), unresolvedFraction: float(0) }
  return neededStrength(layer, height)
    .sub(columnStrength(layer, most, coverage, sharp))
    .sub(layer.anvil.mul(ANVIL).add(MOST_BILLOWS))
    .mul(BACKGROUND_LIKELY)
    .div(layer.perWeatherPeriod)
    .sub(footprint.mul(BLUR))
}

/**
 * Part of a storm's distance that counts: a pair is two steps long, and the distance is that of the middle of the one before. Greater:
 * towers are missed by level rays, as blades (*Storm*).
 */
const PAIRED = 0.5

/**
 * Likely distance of the storms of a layer, whatever billows and turbulence add: there these need not be looked up [m]. 0
 * or less elsewhere.
 *
 * @param sample - The place.
 */
export function likelyDistanceOfStorms(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  sample: CloudSample,
  height: Float
): Float {
  const still = vec2(0) as Vec2
  const subpoint = subpointOffset(field, sample)
    .sub(leanAt(layer, sample.up, height))
    .toConst()
  const resolution = resolutionAt(layer, footprintOf(field, sample))
  const around = unpackBackground(background)
  const weather = cloudWeather(
    field,
    layer,
    around,
    subpoint,
    still,
    resolution,
    'where unresolved'
  )
  const isResolved = resolution.unresolvedFraction.equal(0)
  return smoothStormStrength(layer, weather, height)
    .negate()
    .sub(stormBillows.most)
    .mul(stormBillows.unit * PAIRED)
    .div(layer.perShapePeriod)
    .mul(isResolved.select(1, 0))
}
