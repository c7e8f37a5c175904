import { float, smoothstep } from 'three/tsl'
import { select } from '../../select'
import { densityForm } from '../formConstants'
import type { Float } from '../../tsl-types'
import type { LayerNodes } from './layer'
import { isStorm } from './storm'

/** A layer at a place. */
export interface LayerSample {
  /** Extinction [1/m], at least 0. */
  readonly extinction: Float
  /**
   * Strength of the column with all its billows, less what the height needs: cloud is where it is above 0
   * [–]. Far away, where single clouds are not resolved, at least 0.
   */
  readonly strength: Float
  /** `surfaceStrength` [–]. */
  readonly surface: Float
}

/**
 * Strength over which density rises at edges [–]. Bases, where clouds form and decay, are softer than tops.
 *
 * @param height - ĥ in the layer, in [0, 1].
 */
export const edgeAt = (layer: LayerNodes, height: Float): Float => {
  const low = height.oneMinus().toConst()
  return low.mul(low).mul(densityForm.softerBase).add(1).div(layer.perEdge).toConst()
}

/** Width of an edge above which steps are longer [–]. Less: faster, and ceilings lose their relief to streaks and grain (*Presets*, overcast). */
const SOFT_EDGE = 0.8
/** Least share of a layer's density that steps go by [–]. Less: the same. */
const LEAST_DENSE = 0.45

/**
 * Share of a layer's density that steps go by until they find more, in [`LEAST_DENSE`, 1]: density rises slowly behind soft edges.
 *
 * @param height - ĥ in the layer.
 */
export const denseShare = (layer: LayerNodes, height: Float): Float =>
  select(isStorm(layer), 1, float(SOFT_EDGE).div(edgeAt(layer, height)).clamp(LEAST_DENSE, 1))

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

/**
 * Strength by which edges are found between samples [–]: where it is 0, a cloud begins that is even, and as deep as this one. In storms that is half an
 * edge behind: those of ice are thicker than a mean free path.
 */
export function surfaceStrength(layer: LayerNodes, strength: Float, edge: Float): Float {
  if (layer.hasStorms === false) return strength
  const inside = strength.mul(0.5).max(strength.sub(edge.mul(0.5)))
  return select(isStorm(layer).and(strength.greaterThan(0)), inside, strength).toConst()
}
