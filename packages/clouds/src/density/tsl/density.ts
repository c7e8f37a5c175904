import { densityForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'

/**
 * Density over a layer's at its height, in [0, 1]: it rises from 0 at the edge over the layer's softness, and
 * is full in the core.
 *
 * @param strength - With all billows and detail: cloud is where it is above 0.
 * @param body - With coarse billows alone: it says how deep inside a place is.
 */
export const densityOf = (layer: LayerNodes, strength: Float, body: Float): Float => {
  const { edgeDensity, core } = densityForm
  const inside = body.div(core).clamp(0, 1).sqrt()
  return strength.mul(layer.perEdge).clamp(0, 1).mul(inside.mix(edgeDensity, 1)).toConst() as Float
}
