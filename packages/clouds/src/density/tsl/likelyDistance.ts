import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'

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
