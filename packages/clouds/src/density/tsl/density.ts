import { float, smoothstep } from 'three/tsl'
import { densityForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'
import { isStorm } from './storm'

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
 * Strength over which density rises from which on steps are longer than the layer's density asks for, and the least share of that density they
 * go by [–]. Less of either: faster, and ceilings lose their relief to streaks and grain (*Presets*, overcast).
 */
const SOFT_EDGE = 0.8
const LEAST_DENSE = 0.45

/**
 * Share of a layer's density at a height that steps go by before they have found more, in [0, 1]: behind soft edges density rises slowly.
 *
 * @param height - ĥ in the layer.
 */
export const denseShare = (layer: LayerNodes, height: Float): Float =>
  isStorm(layer).select(1, float(SOFT_EDGE).div(edgeAt(layer, height)).clamp(LEAST_DENSE, 1))

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
