import { smoothstep } from 'three/tsl'
import { densityForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'

/**
 * Strength over which density rises at edges [–]. Bases, where clouds form and decay, are softer than tops.
 *
 * @param height - ĥ in the layer, in [0, 1].
 */
export const edgeAt = (layer: LayerNodes, height: Float): Float => {
  const low = height.oneMinus().toConst()
  return low.mul(low).mul(densityForm.softerBase).add(1).div(layer.perEdge).toConst()
}

/**
 * Density over a layer's at its height, in [0, 1]: it rises from 0 at the edge, and is full inside.
 *
 * @param strength - With all billows and detail: cloud is where it is above 0.
 * @param edge - `edgeAt`.
 */
export const densityOf = (strength: Float, edge: Float): Float => strength.div(edge).clamp()

/**
 * Factor of the density at a place: bits of cloud that only billows make are mixed with clear air.
 *
 * @param column - Strength of the column, without billows [–].
 * @param needed - `neededStrength` at the height [–]: tops of strong columns are no bits.
 */
export const crumbDensity = (column: Float, needed: Float): Float => {
  const { crumb, crumbFrom, crumbHeight } = densityForm
  return smoothstep(...crumbFrom, column.sub(needed.mul(crumbHeight)))
    .mul(1 - crumb)
    .add(crumb)
    .toConst()
}
