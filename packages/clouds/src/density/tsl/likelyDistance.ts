import { float, vec2 } from 'three/tsl'
import { select } from '../../select'
import type { CloudField } from '../CloudField'
import { stormBillows, stormFibres } from '../stormForm'
import type { Float, Vec2 } from '../../tsl-types'
import { iceAt, neededStrength } from './heightForm'
import { heightIn, type LayerNodes } from './layer'
import { resolutionAt } from './resolution'
import { footprintOf, type CloudSample } from './sample'
import { isStorm } from './storm'
import { keepStorm, type KeptStorm } from './stormNearby'
import { smoothStormStrength } from './stormStrength'
import { columnStrength } from './strength'
import { cloudWeather, footOf, stormsAt } from './weather'
import { unpackBackground, type PackedBackground } from './weatherBackground'

/** Distance that is farther than any cloud [m]. */
export const NOWHERE = 1e6

/**
 * Distance over which the strength of clear air changes by 1 in the mean towards a cloud [periods of the
 * shape]. Greater: faster, and small clouds are missed here and there, as grain (*Cumulus*).
 */
const LIKELY = 0.007

/**
 * `LIKELY` in layers of storms. Their strength is a distance, but heads on heads are steeper by far. Greater: heads are
 * missed, by whole rows of pixels as horizontal slits in towers (*Storm*).
 */
const LIKELY_OF_STORMS = 0.003

/**
 * Part of the likely distance that steps take: the rest is left for clouds that are nearer than likely. Greater:
 * faster, and small clouds are missed here and there, as grain (*Cumulus*).
 */
export const CAUTION = 0.7

/**
 * Likely distance of a layer's clouds. It is no bound, since the slope of strength has none, so a march that steps by it has to look back. 0 in clouds [m].
 *
 * @param strength - Strength of a `LayerSample`.
 */
export const likelyDistance = (layer: LayerNodes, strength: Float): Float => {
  const perStrength = select(isStorm(layer), LIKELY_OF_STORMS, LIKELY)
  return strength.negate().max(0).mul(perStrength).div(layer.perShapePeriod)
}

/** Greatest likely distance of storms that were sampled [m]. */
export const nearStorms = (layer: LayerNodes): Float =>
  float(stormBillows.most * LIKELY_OF_STORMS).div(layer.perShapePeriod)

/**
 * Strength that billows add to clear air in nearly all places, and what anvils add: they spread from column to column, and so no background
 * rules them out [–]. Smaller: faster, and heads of far clouds are missed by whole rows of pixels: cumulus look as if made of
 * plates (*Presets*).
 */
const MOST_BILLOWS = 2.5
const ANVIL = 99

/**
 * Distance over which the background's part of the strength changes by 1 [periods of the weather]. Greater: faster, and
 * edges of clear regions get ragged (*Cockpit*).
 */
const BACKGROUND_LIKELY = 0.3

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
 * Length of each of the next two steps over the stretch that is surely clear of storms. From 0.5 on they reach beyond its end, where
 * nothing is sampled: horizontal slits in towers (*Storm*).
 */
const SURE = 0.45

/**
 * Likely distance of the storms of a layer, whatever billows and turbulence add: there these need not be looked up [m]. 0
 * or less elsewhere.
 *
 * @param middle - The place in the middle between a pair of samples.
 * @param length - Distance between them; as much lies beyond them [m].
 * @param nearby - Gets the storms nearest to it.
 */
export function clearOfStorms(
  field: CloudField,
  layer: LayerNodes,
  background: PackedBackground,
  middle: CloudSample,
  length: Float,
  nearby: KeptStorm
): Float {
  const height = heightIn(layer, middle.altitude)
  const subpoint = footOf(field, layer, middle, height)
  const resolution = resolutionAt(layer, footprintOf(field, middle))
  const around = unpackBackground(background)
  keepStorm(nearby, stormsAt(field, layer, around, subpoint))
  const still = vec2(0) as Vec2
  const weather = cloudWeather(field, layer, around, subpoint, still, resolution, nearby)
  const fray = weather.stormRadius.mul(iceAt(layer, height)).mul(stormFibres.mostFray)
  const stormDistance = weather.stormDistance.sub(fray)
  const clear = smoothStormStrength(layer, { ...weather, stormDistance }, height)
    .negate()
    .sub(stormBillows.most)
    .mul(stormBillows.unit)
    .div(layer.perShapePeriod)
    .toConst() as Float
  // Both samples are in clear air, and what lies before the end of the pair is gone by.
  const isSure = clear.greaterThan(length).and(resolution.unresolvedFraction.equal(0))
  return select(
    isSure,
    clear
      .sub(length)
      .max(1)
      .mul(SURE / CAUTION),
    0
  )
}
